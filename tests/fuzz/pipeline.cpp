// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fuzz/drawings.h"
#include "kontur/segment.h"

namespace kontur::fuzz {
namespace {

SegmentOptions options(Choices& choose) {
    SegmentOptions options;
    options.mesh = choose.flag();
    options.normals = choose.below(4) == 0 ? Normals::in_plane : Normals::surface;
    options.fill_rule = choose.below(4) == 0 ? FillRule::declared : FillRule::even_odd;
    options.quality = choose.below(4) == 0 ? 1 : choose.between(0.01, 0.3);  // few points: more drawings in a second
    options.voxelizer = static_cast<Voxelizer>(choose.below(3));
    options.solver = choose.below(3) == 0 ? Solver::iterative : Solver::automatic;
    options.conflicts = static_cast<Conflicts>(choose.below(3));
    if (choose.below(4) == 0) options.smoothing = choose.between(0, 1e-2);
    if (choose.below(8) == 0) options.normal_offset_mm = choose.between(0, 3);
    return options;
}

Grid grid(Choices& choose, const ContourSet& set) {
    const Box3 box = bounding_box(set);
    const double spacing = std::max(box.diagonal(), 1e-9) / (6 + choose.below(14));
    Grid grid = grid_around(box, {spacing, spacing, spacing * (1 + choose.below(3))}, 2 * spacing);
    if (choose.below(4) == 0)  // left-handed and sheared
        grid.index_to_mm.set_column(0, -1 * grid.index_to_mm.column(0) + 0.3 * grid.index_to_mm.column(1));
    return grid;
}

}  // namespace

void pipeline(Bytes bytes) {
    Choices choose(bytes);
    const bool mixed = choose.flag();
    const SegmentOptions chosen = options(choose);
    const ContourSet set = mixed ? mixed_drawing(choose) : wild_drawing(choose);
    check_contours(set);
    const Segmentation result = segment(set, grid(choose, set), chosen);
    const bool whole = static_cast<std::int64_t>(result.mask.values.size()) == result.mask.grid.voxel_count();
    if (!whole || !std::isfinite(result.report.residual.max_mm)) {
        std::fprintf(stderr, "broken promise: a whole mask and a finite residual\n");
        std::abort();
    }
}

}  // namespace kontur::fuzz
