// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/appearance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr std::size_t kNeighbours = 60;  // examples that teach one point
constexpr double kEverywhere = 0.1;      // share of the mean of all examples
constexpr double kUnseen = 0.15;         // probability kept for intensities that no example shows
// Neighbouring voxels are not independent: the likelihood of a line of them counts as this power of itself.
constexpr double kIndependent = 0.4;

// Beyond the offsets that describe the border the image may look like anything: so much holds of what is seen at the last.
constexpr float kBeyond = 0.5F;

constexpr int kOffsets = Appearance::kOffsets, kBins = Appearance::kBins;
using Histograms = Appearance::Histograms;

float& entry(Histograms& h, int offset, int bin) { return h[static_cast<std::size_t>(offset * kBins + bin)]; }

/// The two bins that share a value in [0, 1].
struct BinShare {
    int first = 0, second = 0;
    float weight = 0;  ///< of the second
    explicit BinShare(double value) {
        const double at = std::clamp(value * kBins - 0.5, 0.0, kBins - 1.0);
        first = static_cast<int>(at);
        second = std::min(first + 1, kBins - 1);
        weight = static_cast<float>(at - first);
    }
};

/// A Gaussian with this standard deviation, cut off at 4 of them, its sum 1.
std::vector<float> gaussian(double deviation) {
    const int reach = static_cast<int>(4 * deviation + 0.5);
    std::vector<float> taps;
    for (int i = -reach; i <= reach; ++i)
        taps.push_back(static_cast<float>(std::exp(-0.5 * i * i / (deviation * deviation))));
    const float sum = std::accumulate(taps.begin(), taps.end(), 0.0F);
    for (float& tap : taps) tap /= sum;
    return taps;
}

/// Row b is what a value in bin b is spread over; beyond the ends lies what is at the ends.
using Spread = std::array<std::array<float, kBins>, kBins>;

Spread spread_over_bins() {
    const std::vector<float> taps = gaussian(1.0);
    const int reach = static_cast<int>(taps.size()) / 2;
    Spread spread{};
    for (int to = 0; to < kBins; ++to)
        for (int t = -reach; t <= reach; ++t)
            spread[static_cast<std::size_t>(std::clamp(to + t, 0, kBins - 1))][static_cast<std::size_t>(to)] +=
                taps[static_cast<std::size_t>(t + reach)];
    return spread;
}

/// Few examples teach each point: what they show is spread a little, over bins and offsets.
Histograms histograms_of(std::span<const double> intensities, const IntensityScale& scale) {
    static const std::vector<float> over_offsets = gaussian(0.7);
    static const Spread over_bins = spread_over_bins();
    std::array<std::array<float, kBins>, kOffsets> spread_counts{};
    for (std::size_t t = 0; t < kOffsets; ++t) {
        if (!std::isfinite(intensities[t])) continue;
        const BinShare bin(scale(intensities[t]));
        const auto &first = over_bins[static_cast<std::size_t>(bin.first)],
                   &second = over_bins[static_cast<std::size_t>(bin.second)];
        for (std::size_t b = 0; b < kBins; ++b) spread_counts[t][b] = (1 - bin.weight) * first[b] + bin.weight * second[b];
    }
    Histograms h{};
    const int reach = static_cast<int>(over_offsets.size()) / 2;
    for (int t = 0; t < kOffsets; ++t)
        for (int n = -reach; n <= reach; ++n) {
            const auto& row = spread_counts[static_cast<std::size_t>(std::clamp(t + n, 0, kOffsets - 1))];
            const float tap = over_offsets[static_cast<std::size_t>(n + reach)];
            for (int b = 0; b < kBins; ++b) entry(h, t, b) += tap * row[static_cast<std::size_t>(b)];
        }
    return h;
}

void normalize(Histograms& h) {
    for (int t = 0; t < kOffsets; ++t) {
        float sum = 0;
        for (int b = 0; b < kBins; ++b) sum += entry(h, t, b);
        for (int b = 0; b < kBins; ++b) entry(h, t, b) = sum > 0 ? entry(h, t, b) / sum : 1.0F / kBins;
    }
}

/// By offset, the first and the last for all that lies beyond.
using LogProbabilities = std::array<std::array<float, kBins>, kOffsets + 2>;

LogProbabilities log_probabilities(const Histograms& h) {
    LogProbabilities log;
    for (std::size_t row = 0; row < log.size(); ++row) {
        const std::size_t t = std::clamp<std::size_t>(row, 1, kOffsets) - 1;
        const float share = t + 1 == row ? 1 : kBeyond;
        for (std::size_t b = 0; b < kBins; ++b) log[row][b] = std::log(share * h[t * kBins + b] + (1 - share) / kBins);
    }
    return log;
}

}  // namespace

std::vector<double> intensities_across(const Intensities& image, std::span<const MovingPoint> points, double step_mm,
                                       const Work& work) {
    std::vector<double> values(points.size() * kOffsets);
    parallel_for(static_cast<std::int64_t>(points.size()), 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            for (int t = 0; t < kOffsets; ++t)
                values[i * kOffsets + static_cast<std::size_t>(t)] =
                    image.at(points[i].position + (t - Appearance::kHalf) * step_mm * points[i].normal);
    });
    return values;
}

Appearance::Appearance(const Intensities& image, const IntensityScale& scale, std::span<const MovingPoint> examples,
                       double step_mm, const Work& work)
    : image_(image),
      scale_(scale),
      step_mm_(step_mm),
      examples_(examples.begin(), examples.end()),
      histograms_(examples.size()),
      mean_{} {
    const std::vector<double> values = intensities_across(image, examples, step_mm, work);
    parallel_for(static_cast<std::int64_t>(examples.size()), 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            histograms_[i] = histograms_of(std::span(values).subspan(i * kOffsets, kOffsets), scale);
    });
    for (const Histograms& h : histograms_)
        for (std::size_t n = 0; n < h.size(); ++n) mean_[n] += h[n];
    normalize(mean_);
}

Appearance::Histograms Appearance::local(const MovingPoint& point) const {
    std::vector<std::pair<double, std::size_t>> nearest(examples_.size());
    for (std::size_t i = 0; i < examples_.size(); ++i) {
        const Vec3 apart = examples_[i].position - point.position;
        nearest[i] = {dot(apart, apart), i};
    }
    const std::size_t count = std::min(kNeighbours, nearest.size());
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
    nearest.resize(count);
    const double reach2 = std::max(nearest[count / 2].first, 1e-12);

    Histograms h{};
    double sum = 0;
    for (const auto& [distance2, i] : nearest) {
        const double alike = std::max(0.15 + 0.85 * dot(point.normal, examples_[i].normal), 0.02);
        const double weight = alike * std::exp(-0.5 * distance2 / reach2);
        sum += weight;
        const auto share = static_cast<float>(weight);
        for (std::size_t n = 0; n < h.size(); ++n) h[n] += share * histograms_[i][n];
    }
    const float to_local = static_cast<float>((1 - kEverywhere) / sum);
    for (std::size_t n = 0; n < h.size(); ++n)
        h[n] = to_local * h[n] + static_cast<float>(kEverywhere) * mean_[n] + static_cast<float>(kUnseen / kBins);
    normalize(h);
    return h;
}

std::vector<double> Appearance::log_likelihood(const MovingPoint& point, int most) const {
    const LogProbabilities log = log_probabilities(local(point));
    const int reach = kHalf + most;
    std::vector<double> likelihood(static_cast<std::size_t>(2 * most + 1));
    for (int at = -reach; at <= reach; ++at) {
        const double value = image_.at(point.position + at * step_mm_ * point.normal);
        if (!std::isfinite(value)) continue;
        const BinShare bin(scale_(value));
        std::array<double, kOffsets + 2> by_offset;
        for (std::size_t t = 0; t < by_offset.size(); ++t)
            by_offset[t] = std::lerp(log[t][static_cast<std::size_t>(bin.first)],
                                     log[t][static_cast<std::size_t>(bin.second)], bin.weight);
        for (int u = -most; u <= most; ++u)
            likelihood[static_cast<std::size_t>(u + most)] +=
                by_offset[static_cast<std::size_t>(std::clamp(at - u + kHalf + 1, 0, kOffsets + 1))];
    }
    for (double& l : likelihood) l *= kIndependent;
    return likelihood;
}

}  // namespace kontur
