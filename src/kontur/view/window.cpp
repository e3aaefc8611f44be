// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/window.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

/// Finite values at a regular stride, sorted: enough for percentiles of any volume.
std::vector<double> sorted_values(const Image& image) {
    constexpr std::size_t kEnough = 1u << 18;
    return std::visit(
        [](const auto& samples) {
            const std::size_t stride = samples.size() / kEnough + 1;
            std::vector<double> values;
            for (std::size_t i = 0; i < samples.size(); i += stride)
                if (const auto v = static_cast<double>(samples[i]); std::isfinite(v)) values.push_back(v);
            std::sort(values.begin(), values.end());
            return values;
        },
        image.samples);
}

}  // namespace

Window suggest_window(const Image& image) {
    const std::vector<double> values = sorted_values(image);
    if (values.empty()) return {0, 1};
    if (values.front() <= -200 && values.back() >= 30) return {};
    const std::size_t last = values.size() - 1;
    double low = values[last / 100], high = values[last - last / 100];
    if (!(high > low)) low = values.front(), high = values.back();
    return {0.5 * (low + high), high > low ? high - low : 1};
}

double brightness(double value, const Window& window) {
    const double fraction = (value - window.center) / window.width + 0.5;
    return fraction > 0 ? std::min(fraction, 1.0) : 0;
}

}  // namespace kontur
