// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/view/panels.h"
#include "kontur/view/picture.h"

namespace kontur {

std::string picture::rounded(double value, int digits) {
    const int before_point = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    return fmt::format("{:.{}f}", value, std::clamp(digits - before_point, 0, 12));
}

std::string in_ml(double volume_ml) { return picture::rounded(volume_ml, 4) + " ml"; }

}  // namespace kontur
