// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "console.h"
#include "kontur/base/work.h"
#include "kontur/derive/derive.h"
#include "kontur/shape/structure_attributes.h"

namespace kontur::app {

/// What rules work on.
struct DeriveSources {
    std::vector<NamedStructure> structures{};       ///< only those that rules name
    std::vector<StructureAttributes> attributes{};  ///< of each
    std::optional<Image> image{};                   ///< where a rule looks at it
};

/// Reads the structures that the rules name: of label maps and segmentations their voxels, of RTSTRUCTs and contour files
/// what `segment` makes of the contours. Throws what the readers and `check_rules` throw, and Error(invalid_input) for a
/// name that two inputs have and for contours without an image.
DeriveSources read_derive_sources(const DeriveCommand& command, const std::vector<std::string>& rules, Console& console,
                                  const Work& work);

}  // namespace kontur::app
