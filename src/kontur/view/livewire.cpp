// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/livewire.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr std::array<Pixel, 8> kSteps{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// A gradient of this many times the noise's is a clear edge.
constexpr double kClear = 6;

/// Binomial 1 4 6 4 1 along rows or columns, the border repeated.
std::vector<float> smoothed(std::span<const float> values, int width, int height, bool along_rows) {
    constexpr std::array<float, 5> kWeights{1.f / 16, 4.f / 16, 6.f / 16, 4.f / 16, 1.f / 16};
    std::vector<float> result(values.size());
    const auto at = [&](int column, int row) {
        return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
    };
    std::size_t target = 0;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column, ++target)
            for (int k = -2; k <= 2; ++k)
                result[target] += kWeights[k + 2] * (along_rows ? at(std::clamp(column + k, 0, width - 1), row)
                                                                : at(column, std::clamp(row + k, 0, height - 1)));
    return result;
}

double length(const PixelPosition& a, const PixelPosition& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

}  // namespace

EdgeMap::EdgeMap(std::span<const float> values, int width, int height) : width_(width), height_(height) {
    if (width < 3 || height < 3 || values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw Error(ErrorKind::invalid_input, "a slice of " + std::to_string(width) + " x " + std::to_string(height) +
                                                  " pixels with " + std::to_string(values.size()) +
                                                  " values has no edges to follow; at least 3 x 3 are needed");
    const std::vector<float> smooth = smoothed(smoothed(values, width, height, true), width, height, false);
    across_.resize(values.size());
    magnitude_.resize(values.size());
    const auto at = [&](int column, int row) {
        return smooth[offset({std::clamp(column, 0, width - 1), std::clamp(row, 0, height - 1)})];
    };
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const float x = 0.5f * (at(column + 1, row) - at(column - 1, row));
            const float y = 0.5f * (at(column, row + 1) - at(column, row - 1));
            const float g = std::hypot(x, y);
            magnitude_[offset({column, row})] = std::isfinite(g) ? g : 0;
            if (g > 0 && std::isfinite(g)) across_[offset({column, row})] = {double{x} / g, double{y} / g};
        }
    find_ridges();
}

double EdgeMap::magnitude_at(double column, double row) const {
    const double c = std::clamp(column, 0.0, width_ - 1.0), r = std::clamp(row, 0.0, height_ - 1.0);
    const int c0 = std::min(static_cast<int>(c), width_ - 2), r0 = std::min(static_cast<int>(r), height_ - 2);
    const double fc = c - c0, fr = r - r0;
    const auto m = [&](int dc, int dr) { return double{magnitude_[offset({c0 + dc, r0 + dr})]}; };
    return (1 - fr) * ((1 - fc) * m(0, 0) + fc * m(1, 0)) + fr * ((1 - fc) * m(0, 1) + fc * m(1, 1));
}

void EdgeMap::find_ridges() {
    ridge_.assign(magnitude_.size(), 0);
    shift_.assign(magnitude_.size(), 0);
    std::vector<float> ridge_values;
    for (int row = 0; row < height_; ++row)
        for (int column = 0; column < width_; ++column) {
            const std::size_t i = offset({column, row});
            const double here = magnitude_[i];
            if (!(here > 0)) continue;
            const double before = magnitude_at(column - across_[i][0], row - across_[i][1]);
            const double after = magnitude_at(column + across_[i][0], row + across_[i][1]);
            if (here < before || here < after) continue;
            ridge_[i] = 1;
            ridge_values.push_back(magnitude_[i]);
            const double bend = before - 2 * here + after;
            if (bend < 0) shift_[i] = static_cast<float>(std::clamp(0.5 * (before - after) / bend, -0.5, 0.5));
        }
    // Most ridges of an image are noise, so their median measures it; without noise all of them are edges.
    double clear = 0;
    if (!ridge_values.empty()) {
        const auto middle = ridge_values.begin() + static_cast<std::ptrdiff_t>(ridge_values.size() / 2);
        std::nth_element(ridge_values.begin(), middle, ridge_values.end());
        clear = std::min(kClear * *middle, 0.5 * *std::max_element(ridge_values.begin(), ridge_values.end()));
    }
    strength_.resize(magnitude_.size());
    for (std::size_t i = 0; i < magnitude_.size(); ++i)
        strength_[i] = clear > 0 ? static_cast<float>(std::min(1.0, magnitude_[i] / clear)) : 0.f;
}

int EdgeMap::cost(Pixel from, Pixel to) const {
    const std::size_t p = offset(from), q = offset(to);
    const int columns = to.column - from.column, rows = to.row - from.row;
    const bool diagonal = columns != 0 && rows != 0;
    const double scale = diagonal ? std::sqrt(0.5) : 1;
    // An edge runs at right angles to the gradient, so a step along it has none of the gradient's direction.
    const auto against = [&](std::size_t i) { return std::abs(across_[i][0] * columns + across_[i][1] * rows) * scale; };
    const double off_ridge = ridge_[q] ? 0 : 1;
    const double local =
        45 * (1.0 - strength_[q]) + 15 * off_ridge + 12 * (against(p) * strength_[p] + against(q) * strength_[q]);
    return static_cast<int>((diagonal ? 7 : 5) * (1 + local * 0.8));
}

Pixel EdgeMap::snap(Pixel p, int radius) const {
    Pixel best = p;
    double best_score = 0;
    for (int row = std::max(0, p.row - radius); row <= std::min(height_ - 1, p.row + radius); ++row)
        for (int column = std::max(0, p.column - radius); column <= std::min(width_ - 1, p.column + radius); ++column) {
            const double away = std::hypot(column - p.column, row - p.row);
            const std::size_t i = offset({column, row});
            if (away > radius || !ridge_[i]) continue;
            const double score = strength_[i] * (1 - 0.5 * away / std::max(1, radius));
            if (score > best_score) best_score = score, best = {column, row};
        }
    return best;
}

PixelPosition EdgeMap::subpixel_position(Pixel p) const {
    const std::size_t i = offset(p);
    return {p.column + shift_[i] * across_[i][0], p.row + shift_[i] * across_[i][1]};
}

LiveWire::LiveWire(const EdgeMap& edges, Pixel seed, int reach) : edges_(edges), seed_(seed) {
    if (!edges.contains(seed)) throw Error(ErrorKind::invalid_input, "the seed of a live-wire lies outside of the slice");
    check_at_least("the reach of a live-wire", reach, 0);
    first_ = {std::max(0, seed.column - reach), std::max(0, seed.row - reach)};
    last_ = {std::min(edges.width() - 1, seed.column + reach), std::min(edges.height() - 1, seed.row + reach)};
    window_width_ = last_.column - first_.column + 1;
    const auto count = static_cast<std::size_t>(window_width_) * static_cast<std::size_t>(last_.row - first_.row + 1);
    distance_.assign(count, std::numeric_limits<std::uint32_t>::max());
    parent_.assign(count, kUnknown);
    settled_.assign(count, false);
    buckets_.resize(EdgeMap::kMostCost + 1);
    distance_[offset(seed)] = 0;
    buckets_[0].push_back(static_cast<std::uint32_t>(offset(seed)));
    queued_ = 1;
}

std::size_t LiveWire::offset(Pixel p) const {
    return static_cast<std::size_t>(p.row - first_.row) * static_cast<std::size_t>(window_width_) +
           static_cast<std::size_t>(p.column - first_.column);
}

Pixel LiveWire::clamped(Pixel p) const {
    return {std::clamp(p.column, first_.column, last_.column), std::clamp(p.row, first_.row, last_.row)};
}

void LiveWire::search_until(Pixel target) {
    const std::size_t goal = offset(target);
    while (!settled_[goal] && queued_ > 0) {
        std::vector<std::uint32_t>& bucket = buckets_[reached_ % buckets_.size()];
        if (bucket.empty()) {
            ++reached_;
            continue;
        }
        const std::uint32_t at = bucket.back();
        bucket.pop_back();
        --queued_;
        if (!settled_[at] && distance_[at] == reached_) settle(at);
    }
}

void LiveWire::settle(std::uint32_t at) {
    settled_[at] = true;
    const Pixel from{first_.column + static_cast<int>(at) % window_width_,
                     first_.row + static_cast<int>(at) / window_width_};
    for (std::size_t step = 0; step < kSteps.size(); ++step) {
        const Pixel to{from.column + kSteps[step].column, from.row + kSteps[step].row};
        if (!(clamped(to) == to)) continue;
        const std::size_t next = offset(to);
        if (settled_[next]) continue;
        const std::uint32_t length = reached_ + static_cast<std::uint32_t>(edges_.cost(from, to));
        if (length >= distance_[next]) continue;
        distance_[next] = length;
        parent_[next] = static_cast<std::uint8_t>(step);
        buckets_[length % buckets_.size()].push_back(static_cast<std::uint32_t>(next));
        ++queued_;
    }
}

std::vector<Pixel> LiveWire::path_to(Pixel target) {
    target = clamped(target);
    search_until(target);
    std::vector<Pixel> path{target};
    while (!(path.back() == seed_)) {
        const Pixel step = kSteps[parent_[offset(path.back())]];
        path.push_back({path.back().column - step.column, path.back().row - step.row});
    }
    std::reverse(path.begin(), path.end());
    return path;
}

std::vector<PixelPosition> smooth_path(const EdgeMap& edges, std::span<const Pixel> path) {
    constexpr int kPasses = 3;
    std::vector<PixelPosition> line;
    for (const Pixel& p : path) {
        const PixelPosition at = edges.subpixel_position(p);
        if (line.empty() || length(line.back(), at) > 0.1 || &p == &path.back()) line.push_back(at);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
        std::vector<PixelPosition> next = line;
        for (std::size_t i = 1; i + 1 < line.size(); ++i)
            for (int axis = 0; axis < 2; ++axis)
                next[i][axis] = 0.25 * line[i - 1][axis] + 0.5 * line[i][axis] + 0.25 * line[i + 1][axis];
        line = std::move(next);
    }
    return line;
}

}  // namespace kontur
