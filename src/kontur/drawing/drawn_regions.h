// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/drawn_planes.h"
#include "kontur/drawing/section_probes.h"
#include "kontur/shape/section.h"

namespace kontur {

/// Where a line of another plane crosses this one outside of what was drawn in it.
struct OutsideCrossing {
    Point2 at;
    double clearance;  ///< mm to the nearest line of this plane
};

/// What was drawn in one plane, for questions about any place.
struct DrawnRegion {
    const Section& section;
    SectionSearch search;
    std::vector<Probe> inside;  ///< a lattice over the region
    std::vector<Vec3> places;   ///< the same and some of its lines, mm
    Ball3 ball;                 ///< around the places
    std::vector<OutsideCrossing> crossings;
};

/// The regions of all drawn planes. `planes` must outlive them.
std::vector<DrawnRegion> drawn_regions(const DrawnPlanes& planes, const Work& work = {});

/// The noise of a bound that fades out as `belief` goes from 1 to 0. By its square: there are very many bounds, and together
/// they weigh as much as one that is surer.
double faded(double noise_mm, double belief);

/// Bounds that are believed less than this are left out: their noise is ten thousand times as large.
constexpr double kLeastBelief = 0.01;

}  // namespace kontur
