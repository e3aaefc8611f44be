// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/spread.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kontur {
namespace {

/// By how much the line turns at each of its points, in steps that are more than rounding.
std::vector<double> turns(const LinePoints& line) {
    constexpr double kStep = 1e-4;  // rad
    const std::vector<Vec3>& at = line.positions;
    const std::size_t n = at.size();
    std::vector<double> result(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (!line.is_ring && (i == 0 || i + 1 == n)) continue;
        const Vec3 before = at[i] - at[(i + n - 1) % n], after = at[(i + 1) % n] - at[i];
        result[i] = std::round(std::atan2(norm(cross(before, after)), dot(before, after)) / kStep);
    }
    return result;
}

/// A line of which points are taken.
class Spread {
public:
    explicit Spread(const LinePoints& line) : line_(line), is_near_(line.positions.size(), false) {}

    /// Marks what is near a point that is taken, on both sides.
    void take(std::size_t i, double apart_mm, std::size_t neighbours) {
        for (const bool ahead : {true, false}) {
            double away_mm = 0;
            std::size_t at = i, steps = 0;
            for (std::size_t next = beside(at, ahead); next != at && next != i; at = next, next = beside(at, ahead)) {
                away_mm += distance(line_.positions[at], line_.positions[next]);
                if (++steps > neighbours && away_mm >= apart_mm) break;
                is_near_[next] = true;
            }
        }
        is_near_[i] = true;
    }

    bool is_near(std::size_t i) const { return is_near_[i]; }

private:
    /// The same point at the end of an open line.
    std::size_t beside(std::size_t i, bool ahead) const {
        const std::size_t n = is_near_.size();
        if (ahead) return i + 1 < n ? i + 1 : line_.is_ring ? 0 : i;
        return i > 0 ? i - 1 : line_.is_ring ? n - 1 : i;
    }

    const LinePoints& line_;
    std::vector<bool> is_near_;
};

}  // namespace

std::vector<bool> spread_along(const LinePoints& line, std::span<const double> apart_mm, std::size_t neighbours) {
    const std::size_t n = line.positions.size();
    const std::vector<double> turn = turns(line);
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turn[a] < turn[b]; });
    Spread spread(line);
    std::vector<bool> is_chosen(n, false);
    for (const std::size_t i : order) {
        if (spread.is_near(i)) continue;
        is_chosen[i] = true;
        spread.take(i, apart_mm[i], neighbours);
    }
    return is_chosen;
}

}  // namespace kontur
