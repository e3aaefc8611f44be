// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/wrong_cells.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

constexpr double kBeside = 1e-6;  // edges: a plane between two layers of cells is in both, however they are rounded
// Standard errors over the planes by which the walk has to be better, where the image has shown that it helps to move the
// surface and where it has not; there it has to leave out a tenth of what is wrong, too, which images beside the drawing
// do not (docs/decisions/0008-image-error.md).
constexpr double kSureBesideMoved = 0.5, kSureAlone = 1;
constexpr double kMostLeft = 0.9;
constexpr std::size_t kLeastPlanesTelling = 3;

bool is_surely_positive(const std::vector<double>& gains, double standard_errors) {
    const auto count = static_cast<double>(gains.size());
    double mean = 0, squares = 0;
    for (const double gain : gains) mean += gain / count;
    for (const double gain : gains) squares += (gain - mean) * (gain - mean);
    return mean > 0 && mean > standard_errors * std::sqrt(squares / (count - 1) / count);
}

}  // namespace

WrongCells count_wrong(const ContourSet& left_out, const ImageCells& cells, const CellDepths& alone, const CellDepths& moved,
                       const VoxelWalk& walk) {
    WrongCells wrong;
    const bool is_open = std::any_of(left_out.contours.begin(), left_out.contours.end(),
                                     [](const Contour& contour) { return !contour.closed; });
    const std::vector<Section> sections = sections_of(left_out, kSamePlane * diameter_mm(left_out));
    if (is_open || sections.empty()) return wrong;
    const Section& section = sections.front();
    const SectionSearch search(section);
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += (0.5 + kBeside) * std::abs(dot(section.plane.normal, cells.grid.index_to_mm.column(axis)));
    for (std::size_t n = 0; n < cells.looks.size(); ++n) {
        const Vec3 p = cells.center(n);
        if (std::abs(section.plane.distance_to(p)) > reach) continue;
        const bool drawn = search.contains(section.plane.to_uv(p));
        wrong.drawn += drawn;
        wrong.alone += alone.is_inside(n) != drawn;
        wrong.moved += moved.is_inside(n) != drawn;
        wrong.walked += walk.is_inside(n) != drawn;
    }
    return wrong;
}

WrongCells sum(std::span<const WrongCells> planes) {
    WrongCells all;
    for (const WrongCells& plane : planes) {
        all.alone += plane.alone;
        all.moved += plane.moved;
        all.walked += plane.walked;
        all.drawn += plane.drawn;
    }
    return all;
}

bool walk_helps(std::span<const WrongCells> planes, bool is_moved_used) {
    std::vector<double> over_alone, over_moved;
    for (const WrongCells& plane : planes) {
        if (plane.drawn == 0) continue;
        over_alone.push_back(plane.alone - plane.walked);
        over_moved.push_back(plane.moved - plane.walked);
    }
    if (over_alone.size() < kLeastPlanesTelling) return false;
    if (is_moved_used)
        return is_surely_positive(over_alone, kSureBesideMoved) && is_surely_positive(over_moved, kSureBesideMoved);
    const WrongCells all = sum(planes);
    return is_surely_positive(over_alone, kSureAlone) && all.walked <= kMostLeft * all.alone;
}

}  // namespace kontur
