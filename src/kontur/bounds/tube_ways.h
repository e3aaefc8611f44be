// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kontur/bounds/drawn_regions.h"

namespace kontur {

/// Of a tube's way: what is nearer to a plane's lines than that was looked at as it was drawn, and twice as far it was not.
/// Of four helices the mean Dice is .935; 0.25 .935, 0.5 .898.
constexpr double kHidden = 0.35;

/// Radii: sections that are nearer need no help. Half costs few planes .0014, twice tubes .038. Outlines that have no other
/// so near stand alone (lone_outlines.h): half names organs in 8 slices, twice is silent on linked rings by 3 planes.
constexpr double kNearest = 3;

/// What one outline of a plane encloses.
struct RegionPart {
    std::size_t region;
    Vec3 center;
    double radius_mm;           ///< of the circle with its area
    std::vector<Probe> probes;  ///< at least one

    std::size_t outline() const { return probes.front().outline; }
};

/// Of all planes; holes, and what is too small for a probe, are none.
std::vector<RegionPart> region_parts(const std::vector<DrawnRegion>& regions);

/// The way of a tube between two of its rings: a cubic curve that leaves both planes at right angles where these are tilted
/// against each other, else a straight one.
struct TubeWay {
    RegionPart from, to;
    Vec3 leaves, enters;         ///< the planes' normals, unit, along the way
    double length_mm;            ///< between the centres
    double belief;               ///< how surely both rings are of one tube, above kLeastBelief
    double chain;                ///< how surely another way leads on from one of the rings
    std::array<Vec3, 9> places;  ///< at even parameters, from the first centre to the second

    double radius_mm() const { return 0.5 * (from.radius_mm + to.radius_mm); }
    const Vec3& middle() const { return places[places.size() / 2]; }

    /// From a place to the curve.
    double distance_mm(const Vec3& place) const;

    /// How surely the tube goes unseen through a plane of such a normal, if that was drawn somewhere else: not through one
    /// that is parallel to a ring's, a slice of their stack, which shows what is there.
    double hides(const Vec3& normal) const;
};

/// Two sections are joined that are each the nearest one ahead of the other, within 45 degrees of both normals and three
/// radii or more away, somewhat less where they are tilted against each other. That fades out where they are 8 to 10 radii
/// apart or two to three times as far as the ones before them: two bodies one above the other are not joined.
std::vector<TubeWay> tube_ways(const std::vector<DrawnRegion>& regions);

}  // namespace kontur
