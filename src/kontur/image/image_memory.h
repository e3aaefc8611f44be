// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/sureness/image_share.h"

namespace kontur {

/// What the image said of a drawing. It stands in for the image until that has answered for the edited drawing: the border
/// that it showed is still there.
class ImageMemory {
public:
    ImageMemory() = default;
    ImageMemory(ContourSet contours, std::vector<ImageShare> shares)
        : contours_(std::move(contours)), shares_(std::move(shares)) {}

    /// Places, mm, at which the image showed the surface of the drawing and, as far as is known, shows that of an edited
    /// one: those nearer to a contour that is still the same than to any that came, went or changed.
    std::vector<Vec3> places_in(const ContourSet& set) const;

private:
    ContourSet contours_;
    std::vector<ImageShare> shares_;
};

}  // namespace kontur
