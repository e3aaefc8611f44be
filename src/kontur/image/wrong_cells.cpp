// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/wrong_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "kontur/image/held_out_errors.h"
#include "kontur/sampling/rise.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

// What shows that an image helps of which moving has not shown it: standard errors over the planes, one of which, but for
// rounding, is what a single plane makes, however many say nothing; and the share of wrong cells that it mends, which images
// beside the drawing do not (docs/decisions/0014-walk-on-voxels.md).
constexpr Rise kSureAlone{1 + 1e-6, 2}, kMendedAlone{0.05, 0.15};
constexpr Rise kSure{0.0228, 0.9772};  // probabilities: two standard deviations

/// The mean in its standard errors.
double sureness(const std::vector<double>& gains) {
    const auto count = static_cast<double>(gains.size());
    double mean = 0, squares = 0;
    for (const double gain : gains) mean += gain / count;
    for (const double gain : gains) squares += (gain - mean) * (gain - mean);
    return in_errors(mean, std::sqrt(squares / (count - 1) / count));
}

/// That a normal variable with this mean, in standard deviations, is above 0; what is nearly sure, or nearly impossible, is
/// wholly, so that no solve is made for it.
double probability(double mean) { return kSure.at(0.5 * std::erfc(-mean / std::numbers::sqrt2)); }

}  // namespace

WrongCells count_wrong(const ContourSet& left_out, const ImageCells& cells, const CellDepths& by_contours,
                       const CellDepths& by_movement, const VoxelWalk& by_walk) {
    WrongCells wrong;
    const bool is_open = std::any_of(left_out.contours.begin(), left_out.contours.end(),
                                     [](const Contour& contour) { return !contour.closed; });
    const std::vector<Section> sections = sections_of(left_out, kSamePlane * diameter_mm(left_out));
    if (is_open || sections.empty()) return wrong;
    const Section& section = sections.front();
    const SectionSearch search(section);
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += (0.5 + kBetweenCells) * std::abs(dot(section.plane.normal, cells.grid.index_to_mm.column(axis)));
    for (std::size_t n = 0; n < cells.looks.size(); ++n) {
        const Vec3 p = cells.center(n);
        if (std::abs(section.plane.distance_to(p)) > reach) continue;
        const bool is_drawn = search.contains(section.plane.to_uv(p));
        wrong.inside += is_drawn;
        wrong.by_contours += by_contours.is_inside(n) != is_drawn;
        wrong.by_movement += by_movement.is_inside(n) != is_drawn;
        wrong.by_walk += by_walk.is_inside(n) != is_drawn;
    }
    return wrong;
}

WrongCells sum(std::span<const WrongCells> planes) {
    WrongCells all;
    for (const WrongCells& plane : planes) {
        all.by_contours += plane.by_contours;
        all.by_movement += plane.by_movement;
        all.by_walk += plane.by_walk;
        all.inside += plane.inside;
    }
    return all;
}

double walk_weight(std::span<const WrongCells> planes, double moving) {
    std::vector<double> over_alone, over_base;
    for (const WrongCells& plane : planes) {
        if (plane.inside == 0) continue;
        over_alone.push_back(plane.by_contours - plane.by_walk);
        over_base.push_back(std::lerp(plane.by_contours, plane.by_movement, moving) - plane.by_walk);
    }
    if (over_alone.size() < kFewestPlanes) return 0;
    const WrongCells all = sum(planes);
    const double gain = all.by_contours > 0 ? 1 - all.by_walk / all.by_contours : 0;
    const double proof = std::lerp(kSureAlone.at(sureness(over_alone)) * kMendedAlone.at(gain), 1.0, moving);
    return proof * probability(sureness(over_alone)) * probability(sureness(over_base));
}

}  // namespace kontur
