// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "kontur/shape/structure_attributes.h"

namespace kontur {

/// A structure's attributes as an object of JSON, as they stand in kontur's contour file; those that are not set are left
/// out. For programs that keep them in files of their own; not part of the public API. Throws Error(invalid_input) for a
/// text that is no UTF-8 and a number that is NaN or infinite.
std::string to_json(const StructureAttributes& attributes);

/// Of such an object, whose other members are passed over. Throws Error(corrupt_file) naming the key.
StructureAttributes attributes_from_json(std::string_view text);

}  // namespace kontur
