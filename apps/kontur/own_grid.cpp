// SPDX-License-Identifier: Apache-2.0
#include "own_grid.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
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

void name_margin(const SegmentCommand& command, std::vector<std::string>& warnings) {
    if (!command.image.path.empty()) return;
    for (std::string& warning : warnings)
        if (warning.starts_with("the object reaches the border of the image"))
            warning =
                fmt::format("the object reaches beyond the {:g} mm of --margin-mm around the contours and is cut off there",
                            command.margin_mm);
}

}  // namespace kontur::app
