// SPDX-License-Identifier: Apache-2.0
#include "own_grid.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::app {

Grid own_grid(const SegmentCommand& command, const Box3& contours) {
    const std::vector<double>& s = command.spacing_mm;
    const Grid grid =
        grid_around(contours, s.size() == 3 ? Vec3{s[0], s[1], s[2]} : Vec3{s[0], s[0], s[0]}, command.margin_mm);
    const std::int64_t limit = command.image.options.max_voxels;
    if (grid.voxel_count() > limit)
        throw Error(ErrorKind::too_large, fmt::format("a spacing of {:g} mm gives the mask {} voxels; the limit is {}", s[0],
                                                      grid.voxel_count(), limit));
    return grid;
}

}  // namespace kontur::app
