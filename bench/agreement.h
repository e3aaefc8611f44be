// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "kontur/measure/compare.h"
#include "kontur/segment.h"

namespace kontur {

/// The paper's method: in-plane normals of 1 mm, exact interpolation.
inline SegmentOptions as_printed() {
    SegmentOptions options;
    options.kernel = Kernel::triharmonic;
    options.normals = Normals::in_plane;
    options.normal_offset_mm = 1;
    options.solver = Solver::cholesky;
    return options;
}

inline nlohmann::ordered_json to_json(const Comparison& c) {
    nlohmann::ordered_json json{{"dice", c.dice}};
    if (c.surface) {
        json["hausdorff95_mm"] = c.surface->hausdorff95_mm;
        json["mean_surface_distance_mm"] = c.surface->mean_surface_distance_mm;
    }
    return json;
}

/// The same field of view with voxels of twice the size.
inline Grid coarsened(const Grid& grid) {
    Grid coarse = grid;
    for (int axis = 0; axis < 3; ++axis) {
        coarse.size[axis] = (grid.size[axis] + 1) / 2;
        coarse.index_to_mm.set_column(axis, 2.0 * grid.index_to_mm.column(axis));
    }
    coarse.index_to_mm.translation += 0.5 * grid.index_to_mm.apply_linear({1, 1, 1});
    return coarse;
}

/// How the agreement grows with the number of planes drawn: the phantom's organs cut by 3 to 20 axial, orthogonal and random
/// planes, each by kontur's defaults and by the paper's method. A list of rows, as `accuracy --counts` prints it.
nlohmann::ordered_json agreement_by_count();

/// What where a stack of parallel planes begins does: the phantom's organs across each axis in about 6 and 12 gaps, the
/// first plane .1, .3, .5, .7 and .9 of a gap above the organ's lowest point. A list of rows, as `accuracy --phases` prints
/// it.
nlohmann::ordered_json agreement_by_phase();

/// How the result changes with what a drawing does not say: rings that are stored backwards or begin elsewhere, contours in
/// another order, all of it mirrored, with its axes exchanged, and turned. For each way the Dice with the mask as the
/// drawing came, what the Dice with the truth changes by, and how far the surfaces are from each other (root mean square,
/// most), in mm, as `accuracy --stored` prints it.
nlohmann::ordered_json agreement_by_storage(const ContourSet& contours, const Mask& truth);

}  // namespace kontur
