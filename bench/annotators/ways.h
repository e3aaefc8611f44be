// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>

#include "annotator.h"

namespace kontur {

/// What is measured after `count` planes, for the counts in their order until the annotator is done.
using Report = std::function<void(const Annotator&)>;

struct WayLimits {
    std::size_t most_planes = 13;
    double enough_dice = 0.98;           ///< twice in a row ends the drawing
    UseImage use_image = UseImage::off;  ///< between the contours, where the truth has one
};

/// Ways to choose planes, by name. `suggestion`, `suggested slices`, `MITK's rule` and `rule, then random` ask after every
/// contour; `axial` adds one slice after another, halving the widest gap; `axial, re-spaced` and `orthogonal` space all
/// slices anew for each count, with hindsight; `random oblique` as it says.
const std::map<std::string, std::function<void(const Truth&, const WayLimits&, const Report&)>>& ways();

}  // namespace kontur
