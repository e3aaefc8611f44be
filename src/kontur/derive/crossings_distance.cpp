// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/crossings_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Weights along one axis, squared.
struct AxisWeights {
    double before, behind;  ///< of places that lie before the crossing, and behind it

    double cost(double apart) const { return (apart < 0 ? before : behind) * apart * apart; }
};

/// Lines of a box along one axis: where each begins, and how it goes on.
struct Lines {
    std::int64_t count, length, step;
    std::int64_t inner, outer;  ///< line n begins at n / inner * outer + n % inner

    Lines(const Index3& size, int axis) {
        const std::int64_t steps[] = {1, size.i, size.i * size.j};
        length = size[axis];
        step = steps[axis];
        count = size.i * size.j * size.k / length;
        inner = axis == 0 ? 1 : step;
        outer = axis == 0 ? size.i : step * length;
    }
    std::int64_t first(std::int64_t line) const { return line / inner * outer + line % inner; }
};

/// The lower envelope of cost(x - q) + value(q) along one line, x and q in steps. Steps of the line are whole numbers, so
/// that for equal weights on both sides the divisions are known before.
template <bool kIsEven>
class Envelope {
public:
    Envelope(const AxisWeights& weights, double spacing_mm, double most, std::int64_t length)
        : before_(weights.before * spacing_mm * spacing_mm), behind_(weights.behind * spacing_mm * spacing_mm), most_(most) {
        parts_.reserve(static_cast<std::size_t>(length));
        for (std::int64_t n = 0; n < length; ++n) halves_.push_back(0.5 / (behind_ * static_cast<double>(n)));
    }

    void apply(float* squared, std::int64_t length, std::int64_t step) {
        parts_.clear();
        for (std::int64_t q = 0; q < length; ++q)
            if (squared[q * step] != kFar) add(q, static_cast<double>(squared[q * step]));
        if (parts_.empty()) return;
        // Beyond the reach of the outermost ones nothing changes: all is far there.
        const auto from = parts_.front().place - static_cast<std::int64_t>(std::sqrt(most_ / before_)) - 1;
        const auto to = parts_.back().place + static_cast<std::int64_t>(std::sqrt(most_ / behind_)) + 1;
        const Part* part = parts_.data();
        const Part* const last = part + parts_.size() - 1;
        for (std::int64_t n = std::max(from, std::int64_t{0}); n <= std::min(to, length - 1); ++n) {
            while (part < last && part[1].from < static_cast<double>(n)) ++part;
            const double sum = cost(static_cast<double>(n - part->place)) + part->value;
            squared[n * step] = sum <= most_ ? static_cast<float>(sum) : kFar;
        }
    }

private:
    struct Part {
        std::int64_t place;
        double value, from;  ///< it is the lowest from there on
    };

    double cost(double apart) const {
        if constexpr (kIsEven) return behind_ * apart * apart;
        else return (apart < 0 ? before_ : behind_) * apart * apart;
    }

    /// From where on the later one of two is the lower one.
    double meeting(const Part& a, const Part& b) const {
        const double apart = static_cast<double>(b.place - a.place), middle = 0.5 * static_cast<double>(a.place + b.place);
        const double more = b.value - a.value;
        if constexpr (kIsEven) return middle + more * halves_[static_cast<std::size_t>(b.place - a.place)];
        const double at_a = -more - before_ * apart * apart, at_b = -more + behind_ * apart * apart;
        if (at_a >= 0) return middle + 0.5 * more / (before_ * apart);
        if (at_b <= 0) return middle + 0.5 * more / (behind_ * apart);
        const double slope = 2 * before_ * apart;
        const double root = std::sqrt(std::max(0.0, slope * slope - 4 * (behind_ - before_) * at_a));
        return static_cast<double>(a.place) - 2 * at_a / (slope + root);
    }

    void add(std::int64_t place, double value) {
        Part next{place, value, -std::numeric_limits<double>::infinity()};
        while (!parts_.empty()) {
            next.from = meeting(parts_.back(), next);
            if (next.from > parts_.back().from) break;
            parts_.pop_back();
            next.from = -std::numeric_limits<double>::infinity();
        }
        parts_.push_back(next);
    }

    double before_, behind_, most_;  ///< per squared step
    std::vector<double> halves_;     ///< half of 1 / (weight * apart)
    std::vector<Part> parts_;
};

class Transform {
public:
    Transform(const Levels& levels, const CrossingsDistanceOptions& options, const Work& work)
        : levels_(levels), options_(options), size_(levels.box.size()), most_(options.reach * options.reach), work_(work) {}

    /// Squared distances to the crossings along one axis, within its lines.
    std::vector<float> along(int axis) const {
        std::vector<float> squared(levels_.values.size(), kFar);
        const Lines lines(size_, axis);
        parallel_for(lines.count, 64, work_, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t line = begin; line < end; ++line) cross(lines, lines.first(line), axis, squared);
        });
        return squared;
    }

    void spread(std::vector<float>& squared, int axis) const {
        if (axis == options_.left_out_axis) return;
        const AxisWeights w = weights(axis);
        w.before == w.behind ? spread_by<true>(squared, axis, w) : spread_by<false>(squared, axis, w);
    }

    void take_least(std::vector<float>& squared, const std::vector<float>& others) const {
        parallel_for(static_cast<std::int64_t>(squared.size()), 1 << 16, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
                squared[n] = std::min(squared[n], others[n]);
        });
    }

private:
    template <bool kIsEven>
    void spread_by(std::vector<float>& squared, int axis, const AxisWeights& w) const {
        const Lines lines(size_, axis);
        parallel_for(lines.count, 64, work_, [&](std::int64_t begin, std::int64_t end) {
            Envelope<kIsEven> envelope(w, options_.spacing_mm[axis], most_, lines.length);
            for (std::int64_t line = begin; line < end; ++line)
                envelope.apply(squared.data() + lines.first(line), lines.length, lines.step);
        });
    }

    AxisWeights weights(int axis) const {
        const auto a = static_cast<std::size_t>(axis);
        const double before = options_.weights.towards_low[a], behind = options_.weights.towards_high[a];
        return {before * before, behind * behind};
    }

    /// Writes around each crossing of a line, as far as it reaches. Costs rise on both sides, so the nearest one on either
    /// side is the least.
    void cross(const Lines& lines, std::int64_t first, int axis, std::vector<float>& squared) const {
        const float* levels = levels_.values.data() + first;
        float* out = squared.data() + first;
        const AxisWeights w = weights(axis);
        const double spacing = options_.spacing_mm[axis];
        for (std::int64_t n = 0; n + 1 < lines.length; ++n) {
            const float here = levels[n * lines.step], next = levels[(n + 1) * lines.step];
            if ((here > 0) == (next > 0)) continue;
            const double place =
                static_cast<double>(n) + static_cast<double>(here) / (static_cast<double>(here) - static_cast<double>(next));
            const auto offer = [&](std::int64_t m) {
                const double cost = w.cost((static_cast<double>(m) - place) * spacing);
                float& value = out[m * lines.step];
                if (cost > most_ || static_cast<float>(cost) >= value) return false;
                value = static_cast<float>(cost);
                return true;
            };
            for (std::int64_t m = n; m >= 0 && offer(m); --m) {
            }
            for (std::int64_t m = n + 1; m < lines.length && offer(m); ++m) {
            }
        }
    }

    const Levels& levels_;
    const CrossingsDistanceOptions& options_;
    Index3 size_;
    double most_;
    const Work& work_;
};

}  // namespace

std::vector<float> crossings_distance(const Levels& levels, const CrossingsDistanceOptions& options, const Work& work) {
    const Transform transform(levels, options, work);
    std::vector<float> least;
    // Crossings along i and j share their last pass.
    if (options.left_out_axis != 0) {
        least = transform.along(0);
        transform.spread(least, 1);
    }
    if (options.left_out_axis != 1) {
        std::vector<float> others = transform.along(1);
        transform.spread(others, 0);
        if (least.empty()) least = std::move(others);
        else transform.take_least(least, others);
    }
    transform.spread(least, 2);
    if (options.left_out_axis != 2) {
        std::vector<float> others = transform.along(2);
        transform.spread(others, 0);
        transform.spread(others, 1);
        transform.take_least(least, others);
    }
    parallel_for(static_cast<std::int64_t>(least.size()), 1 << 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            least[n] = std::sqrt(least[n]);
    });
    return least;
}

}  // namespace kontur
