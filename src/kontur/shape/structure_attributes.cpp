// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/structure_attributes.h"

#include <algorithm>
#include <cmath>

namespace kontur {

StructureAttributes fitted_attributes(StructureAttributes attributes) {
    attributes.generation_algorithm = "SEMIAUTOMATIC";
    attributes.review.approved.reset();
    attributes.review.locked = false;
    return attributes;
}

std::array<std::uint8_t, 3> to_rgb8(const std::array<double, 3>& levels) {
    std::array<std::uint8_t, 3> rgb{};
    std::transform(levels.begin(), levels.end(), rgb.begin(),
                   [](double level) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(level, 0.0, 1.0))); });
    return rgb;
}

std::array<double, 3> to_levels(const std::array<std::uint8_t, 3>& rgb) {
    return {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
}

}  // namespace kontur
