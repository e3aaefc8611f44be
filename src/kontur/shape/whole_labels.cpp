// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/whole_labels.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

/// Floats beyond 2^24 are integers, whose distance says nothing.
bool is_near_label(float value) {
    return std::abs(value) < 16777216.0f && std::abs(value - std::round(value)) <= static_cast<float>(kLabelTolerance);
}

}  // namespace

std::size_t round_to_labels(Image& image) {
    auto* const values = std::get_if<std::vector<float>>(&image.samples);
    if (!values || !std::ranges::all_of(*values, is_near_label)) return 0;
    if (std::ranges::all_of(*values, [](float value) { return std::round(value) == 0; })) return 0;
    std::size_t changed = 0;
    for (float& value : *values) {
        const float label = std::round(value);
        changed += label != value;
        value = label;
    }
    return changed;
}

}  // namespace kontur
