// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/local_looks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kontur {
namespace {

constexpr double kNodes = 1.25;      // reaches from node to node
constexpr double kNegligible = 10;   // of an example's energy: the nearest of its side weighs e^10 times as much
constexpr float kEverywhere = 0.1F;  // share of all examples
constexpr float kUnseen = 0.15F;     // probability kept for looks that no example has
constexpr int kBins = LocalLooks::kBins;

using Histogram = std::array<float, kBins>;

int bin_of(float look) { return std::clamp(static_cast<int>(look * kBins), 0, kBins - 1); }

/// Few examples tell of each place: what they show is spread over the bins beside it.
Histogram spread(const Histogram& h) {
    Histogram wide{};
    constexpr std::array<float, 5> kTaps{1 / 16.0F, 4 / 16.0F, 6 / 16.0F, 4 / 16.0F, 1 / 16.0F};
    for (int b = 0; b < kBins; ++b)
        for (int t = -2; t <= 2; ++t)
            wide[static_cast<std::size_t>(std::clamp(b + t, 0, kBins - 1))] +=
                kTaps[static_cast<std::size_t>(t + 2)] * h[static_cast<std::size_t>(b)];
    return wide;
}

Histogram probabilities(const Histogram& h) {
    Histogram p = spread(h);
    float sum = 0;
    for (const float v : p) sum += v;
    for (float& v : p) v = (1 - kUnseen) * (sum > 0 ? v / sum : 1.0F / kBins) + kUnseen / kBins;
    return p;
}

struct Sides {
    Histogram inside{}, outside{};
    void add(const LookExample& example, float weight) {
        (example.inside ? inside : outside)[static_cast<std::size_t>(bin_of(example.look))] += weight;
    }
    /// Each side's sum 1, if it has any.
    void normalize() {
        for (Histogram* h : {&inside, &outside}) {
            float sum = 0;
            for (const float v : *h) sum += v;
            if (sum > 0)
                for (float& v : *h) v /= sum;
        }
    }
};

/// The nearest examples of each side tell of a place, however far away they are.
Sides sides_at(const Vec3& place, const std::vector<LookExample>& examples, const Sides& all, double reach_mm) {
    double nearest2[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const LookExample& e : examples)
        nearest2[e.inside] = std::min(nearest2[e.inside], dot(e.position - place, e.position - place));
    Sides sides;
    for (const LookExample& e : examples) {
        const double beyond2 = dot(e.position - place, e.position - place) - nearest2[e.inside];
        const double energy = 0.5 * beyond2 / (reach_mm * reach_mm);
        if (energy < kNegligible) sides.add(e, static_cast<float>(std::exp(-energy)));
    }
    sides.normalize();
    for (std::size_t b = 0; b < kBins; ++b) {
        sides.inside[b] = (1 - kEverywhere) * sides.inside[b] + kEverywhere * all.inside[b];
        sides.outside[b] = (1 - kEverywhere) * sides.outside[b] + kEverywhere * all.outside[b];
    }
    return sides;
}

}  // namespace

LocalLooks::LocalLooks(std::vector<LookExample> examples, double reach_mm, const Grid& around,
                       std::span<const Vec3> places) {
    std::erase_if(examples, [](const LookExample& e) { return !std::isfinite(e.look); });
    Sides all;
    std::size_t inside = 0;
    for (const LookExample& e : examples) {
        all.add(e, 1);
        inside += e.inside;
    }
    if (inside == 0 || inside == examples.size()) return;
    all.normalize();
    Affine3 node_to_mm = around.index_to_mm;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 edge = around.index_to_mm.column(axis);
        const double step = kNodes * reach_mm / norm(edge);
        const double steps = std::ceil(static_cast<double>(around.size[axis] - 1) / step);
        size_[axis] = std::max<std::int64_t>(2, static_cast<std::int64_t>(steps) + 1);
        node_to_mm.set_column(axis, step * edge);
    }
    mm_to_node_ = node_to_mm.inverse();
    nodes_.resize(static_cast<std::size_t>(size_.i * size_.j * size_.k));
    std::vector<std::uint8_t> is_needed(nodes_.size());
    for (const Vec3& p : places)
        for (int c = 0; c < 8; ++c) is_needed[corner(cell_of(p), c)] = 1;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        if (!is_needed[n]) continue;
        const auto at = static_cast<std::int64_t>(n);
        const Vec3 place = node_to_mm.apply({static_cast<double>(at % size_.i), static_cast<double>(at / size_.i % size_.j),
                                             static_cast<double>(at / size_.i / size_.j)});
        const Sides sides = sides_at(place, examples, all, reach_mm);
        const Histogram in = probabilities(sides.inside), out = probabilities(sides.outside);
        for (std::size_t b = 0; b < kBins; ++b) nodes_[n][b] = std::log(in[b] / out[b]);
    }
}

LocalLooks::Cell LocalLooks::cell_of(const Vec3& point_mm) const {
    const Vec3 at = mm_to_node_.apply(point_mm);
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double inside = std::clamp(at[axis], 0.0, static_cast<double>(size_[axis] - 1));
        const auto a = static_cast<std::size_t>(axis);
        cell.first[a] = std::min(static_cast<std::int64_t>(inside), size_[axis] - 2);
        cell.part[a] = inside - static_cast<double>(cell.first[a]);
    }
    return cell;
}

std::size_t LocalLooks::corner(const Cell& cell, int corner) const {
    const std::int64_t di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
    return static_cast<std::size_t>(cell.first[0] + di + size_.i * (cell.first[1] + dj + size_.j * (cell.first[2] + dk)));
}

double LocalLooks::log_odds(const Vec3& point_mm, float look) const {
    if (nodes_.empty() || !std::isfinite(look)) return 0;
    const Cell cell = cell_of(point_mm);
    const std::array<double, 3>& part = cell.part;
    const auto bin = static_cast<std::size_t>(bin_of(look));
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
        const double weight =
            (c & 1 ? part[0] : 1 - part[0]) * (c >> 1 & 1 ? part[1] : 1 - part[1]) * (c >> 2 ? part[2] : 1 - part[2]);
        sum += weight * static_cast<double>(nodes_[corner(cell, c)][bin]);
    }
    return sum;
}

}  // namespace kontur
