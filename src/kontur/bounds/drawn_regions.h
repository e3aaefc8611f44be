// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/bounds/section_probes.h"
#include "kontur/drawing/drawn_planes.h"
#include "kontur/shape/section.h"

namespace kontur {

/// Where a line of another plane crosses this one outside of what was drawn in it.
struct OutsideCrossing {
    Point2 at;
    double clearance;  ///< mm to the nearest line of this plane
};

/// Places in groups of some that lie together, so that those near a place are found without looking at all of them.
class GroupedPlaces {
public:
    explicit GroupedPlaces(std::vector<Vec3> places);

    /// All of them, in no particular order.
    const std::vector<Vec3>& all() const { return places_; }

    /// Calls visit(q) for every place q that is nearer to p than so much, in no particular order.
    template <class Visit>
    void visit_within(const Vec3& p, double reach_mm, const Visit& visit) const {
        const double squared = reach_mm * reach_mm;
        for (const Group& group : groups_) {
            const double reach = reach_mm + group.radius;
            if (dot(group.center - p, group.center - p) > reach * reach) continue;
            for (std::size_t i = group.begin; i < group.end; ++i)
                if (dot(places_[i] - p, places_[i] - p) < squared) visit(places_[i]);
        }
    }

private:
    struct Group {
        Vec3 center;
        double radius;  ///< a little more, lest rounding leave a place out
        std::size_t begin, end;
    };

    void group(std::size_t begin, std::size_t end);

    std::vector<Vec3> places_;
    std::vector<Group> groups_;
};

/// What was drawn in one plane, for questions about any place.
struct DrawnRegion {
    const Section& section;
    SectionSearch search;
    std::vector<Probe> inside;  ///< a lattice over the region
    GroupedPlaces places;       ///< the same and some of its lines, mm
    Ball3 ball;                 ///< around the places
    double radius_mm;           ///< of the circle with the area of its largest outline, without its holes
    std::vector<OutsideCrossing> crossings;
};

/// Where the lines of a section cross another plane, in its (u, v).
std::vector<Point2> crossings_with(const Plane& plane, const Section& other);

/// The regions of all drawn planes. `planes` must outlive them.
std::vector<DrawnRegion> drawn_regions(const DrawnPlanes& planes, const Work& work = {});

/// The noise of a bound that fades out as `belief` goes from 1 to 0. By its square: there are very many bounds, and together
/// they weigh as much as one that is surer.
double faded(double noise_mm, double belief);

/// Bounds that are believed less than this are left out: their noise is ten thousand times as large.
constexpr double kLeastBelief = 0.01;

/// The noise of a bound that is sure, of the length that it follows from: an end's height, a tube's radius, the depth below
/// an end. Half costs 32 organ drawings .00035, one of 8 slices .0098, and tubes that end at an empty plane gain .001; twice
/// changes the former by .00001, at most .0017, and costs the latter .002. 9 by hand do not tell.
constexpr double kSureNoise = 0.05;

/// Places at which one outline is asked, and of what it encloses on a tube's way.
constexpr std::size_t kLinePlaces = 24;

/// Calls visit(place) for places at equal steps: `count` of them, up to twice as many where that does not divide, all of
/// fewer.
template <class Place, class Visit>
void for_each_step(const std::vector<Place>& places, std::size_t count, const Visit& visit) {
    const std::size_t stride = std::max<std::size_t>(1, places.size() / count);
    for (std::size_t i = 0; i < places.size(); i += stride) visit(places[i]);
}

/// Sections are of one tube up to so many radii, fading out; kFar: half costs tubes .060.
constexpr double kFar = 8, kTooFar = 10;
/// ... and where they are so many times as far apart as from the sections before them.
constexpr double kUneven = 2, kTooUneven = 3;

/// So much farther a place may lie than its distance says.
constexpr double kRoundedUp = 1 + 1e-9;

}  // namespace kontur
