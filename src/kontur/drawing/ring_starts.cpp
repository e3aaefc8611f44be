// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/ring_starts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kontur/shape/least_rotation.h"

namespace kontur {
namespace {

using Key = std::array<double, 5>;

std::vector<Key> keys_of(const Contour& contour, const Ball3& ball) {
    std::vector<double> x, y, z;
    for (const Vec3& p : contour.points) {
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
    }
    const auto mean = [](std::vector<double>& of) {
        std::ranges::sort(of);  // the same sum in whatever order they came
        double sum = 0;
        for (const double one : of) sum += one;
        return sum / static_cast<double>(of.size());
    };
    const Vec3 middle{mean(x), mean(y), mean(z)};
    std::vector<Key> keys;
    for (const Vec3& p : contour.points)
        keys.push_back({-rounded(distance(p, ball.center), ball), -rounded(distance(p, middle), ball), p.x, p.y, p.z});
    return keys;
}

}  // namespace

double rounded(double mm, const Ball3& ball) {
    constexpr double kRounding = 1e-9;  // of the ball's radius
    return std::round(mm / (kRounding * ball.radius));
}

void begin_alike(Contour& contour, const Ball3& ball) {
    if (!contour.closed || !(ball.radius > 0)) return;
    std::vector<Key> keys = keys_of(contour, ball), backwards(keys.rbegin(), keys.rend());
    const auto begin_first = [](auto& ring, std::size_t start) {
        std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(start), ring.end());
    };
    const std::size_t start = least_rotation(keys), start_backwards = least_rotation(backwards);
    begin_first(keys, start);
    begin_first(backwards, start_backwards);
    const bool turns = backwards < keys;
    if (turns) std::ranges::reverse(contour.points);
    begin_first(contour.points, turns ? start_backwards : start);
}

}  // namespace kontur
