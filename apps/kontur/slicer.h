// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kontur::app {

struct SlicerCommand;

/// The description that 3D Slicer builds the module's panel from: parameters, defaults and the flags to pass. Source: the
/// schema of its command-line modules, "Slicer Execution Model".
std::string slicer_description(const SlicerCommand& defaults);

}  // namespace kontur::app
