// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// f at many places, in mm: one value for each place, above 0 inside of the object.
using PlaceValues = std::function<void(std::span<const Vec3> places_mm, std::span<double> values)>;

/// A connected part of a drawn plane on which the result is on the other side than the drawing.
struct WrongRegion {
    Vec3 position;              ///< mm, the place of it that is farthest from the plane's lines
    double area_mm2 = 0;        ///< of what is deeper than the check's tolerance
    double depth_mm = 0;        ///< of the position, to the nearest line of the plane
    bool is_missing = false;    ///< drawn, and not in the result; else in the result, and not drawn
    bool is_island = false;     ///< not drawn, and connected with nothing that is drawn in the plane
    bool is_lost = false;       ///< a whole region of the drawing of which nothing is in the result
    bool is_explained = false;  ///< planes contradict each other there, so no result is right

    friend bool operator==(const WrongRegion&, const WrongRegion&) = default;
};

/// A drawn plane against the result's section with it.
struct PlaneCheck {
    Plane plane;
    std::optional<std::size_t> contour{};  ///< index of the first one drawn in it; none: a plane given as empty
    double area_mm2 = 0;                   ///< of what is drawn; of an empty plane the mean of all drawn ones
    double wrong_share = 0;                ///< of this area: regions that no contradiction explains
    double island_share = 0;               ///< the same of islands alone
    std::vector<WrongRegion> regions{};    ///< largest first, explained ones included
    bool is_wrong = false;                 ///< more than an unsteady hand makes

    friend bool operator==(const PlaneCheck&, const PlaneCheck&) = default;
};

/// Two planes of which each shows the object across from the other.
struct BetweenCheck {
    std::size_t contour = 0, other = 0;  ///< indices of the first ones drawn in the two planes
    double missing_share = 0;            ///< of the ways along the first plane's normal, those that leave the result
    double gap_mm = 0;                   ///< median length of these ways
    Vec3 position;                       ///< mm, in the middle of one of them
    bool is_wrong = false;

    friend bool operator==(const BetweenCheck&, const BetweenCheck&) = default;
};

/// The result beyond a last plane.
struct BeyondCheck {
    std::size_t contour = 0;  ///< index of the first one drawn in the plane
    double length_mm = 0;     ///< by which it goes on there, mean over the section
    double gap_mm = 0;        ///< between the last plane and the one before, or what other planes reach beyond it
    bool is_flat = false;     ///< the drawing says that the object ends in the plane
    Vec3 position;            ///< mm, on the end
    bool is_wrong = false;

    friend bool operator==(const BeyondCheck&, const BeyondCheck&) = default;
};

/// A result against what was drawn.
struct SectionCheck {
    std::vector<PlaneCheck> planes;
    std::vector<BetweenCheck> between;
    std::vector<BeyondCheck> beyond;
    double outside_share = 0;  ///< of the result, what lies far outside of the ball around all that was drawn
    Vec3 outside_position;     ///< mm, the farthest place of that
    bool is_outside_wrong = false;

    std::size_t wrong_planes() const;
    /// Of any plane.
    double largest_wrong_share() const;

    friend bool operator==(const SectionCheck&, const SectionCheck&) = default;
};

/// Compares a result with its own drawing, whose holes are known (apply_fill_rule): in each drawn plane, the empty ones
/// included, between planes and beyond the last ones.
///
/// A drawn plane is the truth in that plane. Three things are left out. Places nearer to the plane's lines than 0.45 % of
/// the drawing's diameter do not count, nor those whose nearest line is an open contour. Where planes contradict each other
/// no result is right: a region near a stretch of a common line on which two planes differ is explained by it. Where a plane
/// is empty far from its lines, and planes that are no slices of its stack show the object near by, it says nothing: who
/// draws rings across a vessel does not draw the other turns that their planes cut.
///
/// `values` is asked in bulk, a few times, at about 2,000 places for each plane, the same ones for any number of threads.
/// `exact`, if any, is asked again where a region looks wrong: where `values` interpolates. Throws Error(invalid_input) for
/// a set without closed contours.
SectionCheck check_sections(const ContourSet& contours, const PlaceValues& values, const PlaceValues& exact = {},
                            const Work& work = {});

/// One sentence for each kind of fault, with the worst place; contours are counted from 1. Empty where nothing is wrong.
std::vector<std::string> sentences(const SectionCheck& check);

}  // namespace kontur
