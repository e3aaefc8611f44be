// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kontur::app {

struct SlicerCommand;
struct SlicerFillCommand;
struct SlicerCorrectCommand;

/// The description that 3D Slicer builds the module's panel from: parameters, defaults and the flags to pass.
std::string slicer_description(const SlicerCommand& defaults);
std::string slicer_description(const SlicerFillCommand& defaults);
std::string slicer_description(const SlicerCorrectCommand& defaults);

/// Parameters of curves, which `description` describes. Some are shown at once, others under "More curves"; `kinds` asks
/// what line runs between their points.
struct SlicerCurves {
    std::string shown, more, kinds;
};
SlicerCurves slicer_curves(std::string_view description);

/// The flags that the description gives to the curves, of which each takes one file.
std::vector<std::string> slicer_curve_flags();

}  // namespace kontur::app
