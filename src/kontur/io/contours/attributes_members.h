// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal to io: a structure's attributes as members of a larger JSON document.

#include <nlohmann/json.hpp>

#include "kontur/shape/structure_attributes.h"

namespace kontur {

/// Those of a document. Throws Error(corrupt_file) naming the key.
StructureAttributes read_attributes(const nlohmann::json& document);

/// An object with one member for each that is set. Throws as `to_json` does.
nlohmann::ordered_json attribute_members(const StructureAttributes& attributes);

}  // namespace kontur
