// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kontur/shape/volume.h"

namespace kontur {

/// Throws Error(invalid_input), calling the mask `name`, when its grid is invalid or it does not hold one value per voxel.
void check_mask(const Mask& mask, std::string_view name);

}  // namespace kontur
