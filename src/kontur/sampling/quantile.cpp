// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/quantile.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kontur {
namespace {

/// Whole and fractional part of a fraction's place among `count` values.
std::pair<std::size_t, double> place_of(double fraction, std::size_t count) {
    const double place = fraction * static_cast<double>(count - 1);
    const auto below = std::min(static_cast<std::size_t>(place), count - 1);
    return {below, place - static_cast<double>(below)};
}

}  // namespace

double quantile(std::vector<double> values, double fraction) {
    const auto [below, part] = place_of(fraction, values.size());
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(below);
    std::nth_element(values.begin(), at, values.end());
    if (!(part > 0)) return *at;
    return std::lerp(*at, *std::min_element(at + 1, values.end()), part);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double quantile_of_sorted(std::span<const double> sorted, double fraction) {
    const auto [below, part] = place_of(fraction, sorted.size());
    return part > 0 ? std::lerp(sorted[below], sorted[below + 1], part) : sorted[below];
}

double weighted_quantile(std::span<const double> values, std::span<const double> weights, double fraction) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    const double rank = fraction * std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0;
    for (const std::size_t n : order)
        if ((sum += weights[n]) >= rank) return values[n];
    return values[order.back()];
}

}  // namespace kontur
