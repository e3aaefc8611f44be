// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "kontur/shape/volume.h"

namespace kontur {

/// Why a label map of many labels is rather an image: more than half of its labels are scattered, on voxels most of which
/// have no face neighbour of their own label. nullopt for others. Looks at some million voxels.
std::optional<std::string> why_no_labels(const Image& labels);

/// Throws Error(invalid_input) with the reason for a map with `count` labels, 32 or more, that is rather an image: it would
/// be filled for hours.
void check_no_image(const Image& labels, std::size_t count);

}  // namespace kontur
