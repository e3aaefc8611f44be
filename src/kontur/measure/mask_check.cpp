// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/mask_check.h"

#include <fmt/format.h>

#include "kontur/base/error.h"

namespace kontur {

void check_mask(const Mask& mask, std::string_view name) {
    check_grid(mask.grid);
    if (static_cast<std::int64_t>(mask.values.size()) != mask.grid.voxel_count())
        throw Error(ErrorKind::invalid_input, fmt::format("{} has {} values for a grid of {} voxels", name,
                                                          mask.values.size(), mask.grid.voxel_count()));
}

}  // namespace kontur
