// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/missed_clicks.h"

#include <fmt/format.h>

namespace kontur {
namespace {

/// Whether f has both signs on a small ball around a point. Its value at the point itself says nothing: where only that was
/// asked for, f may touch 0 there and stay on one side.
bool passes_near(const ImplicitFunction& function, const Vec3& point, double reach_mm) {
    for (const double radius : {reach_mm, reach_mm / 4}) {
        bool inside = false, outside = false;
        for (const double x : {-1.0, 0.0, 1.0})
            for (const double y : {-1.0, 0.0, 1.0})
                for (const double z : {-1.0, 0.0, 1.0}) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    const Vec3 direction = normalized({x, y, z});
                    (function.value(point + radius * direction) > 0 ? inside : outside) = true;
                    if (inside && outside) return true;
                }
    }
    return false;
}

}  // namespace

std::vector<std::string> missed_clicks(const ContourSet& set, const ImplicitFunction& function, double reach_mm) {
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < set.interior.size(); ++i)
        if (!(function.value(set.interior[i]) > 0))
            sentences.push_back(fmt::format("interior point {} could not be brought inside", i + 1));
    for (std::size_t i = 0; i < set.exterior.size(); ++i)
        if (!(function.value(set.exterior[i]) < 0))
            sentences.push_back(fmt::format("exterior point {} could not be brought outside", i + 1));
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < set.surface.size(); ++i)
        if (!passes_near(function, set.surface[i].position, reach_mm)) numbers.push_back(i + 1);
    if (!numbers.empty())
        sentences.push_back(
            fmt::format("{} of {} surface points could not be reached, the first of them point {}: the surface "
                        "passes more than {:.2g} mm away",
                        numbers.size(), set.surface.size(), numbers.front(), reach_mm));
    return sentences;
}

}  // namespace kontur
