// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/shape/volume.h"

namespace kontur {

/// Within this of an integer a value is that label: what scaling to 16 bits or float noise leaves of one.
constexpr double kLabelTolerance = 1e-3;

/// Rounds the floats of a label map whose writer scaled them, such as 0.99995 for 1. Returns how many voxels changed: 0, and
/// nothing is rounded, where one lies further than `kLabelTolerance` from every integer, where none rounds to other than 0,
/// and for integers.
std::size_t round_to_labels(Image& image);

}  // namespace kontur
