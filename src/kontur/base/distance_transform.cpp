// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// The lower envelope of parabolas (x - q)^2 + value(q) along one line of a lattice.
class Envelope {
public:
    explicit Envelope(std::size_t most) { parabolas_.reserve(most); }

    /// Replaces `count` squared distances, `step` apart in memory and `spacing` in space, by their least sums with squared
    /// distances along the line.
    void apply(float* squared, std::uint32_t* nearest, std::size_t count, std::size_t step, double spacing) {
        parabolas_.clear();
        for (std::size_t q = 0; q < count; ++q)
            if (squared[q * step] != kFar) add({static_cast<double>(q) * spacing, 0, squared[q * step], nearest[q * step]});
        if (parabolas_.empty()) return;
        std::size_t at = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const double x = static_cast<double>(n) * spacing;
            while (at + 1 < parabolas_.size() && parabolas_[at + 1].from < x) ++at;
            const double apart = x - parabolas_[at].place;
            squared[n * step] = static_cast<float>(apart * apart + parabolas_[at].value);
            nearest[n * step] = parabolas_[at].nearest;
        }
    }

private:
    struct Parabola {
        double place, from, value;  ///< it is the lowest from there on
        std::uint32_t nearest;
    };

    void add(Parabola next) {
        next.from = -std::numeric_limits<double>::infinity();
        while (!parabolas_.empty()) {
            const Parabola& last = parabolas_.back();
            next.from = (next.value + next.place * next.place - last.value - last.place * last.place) /
                        (2 * (next.place - last.place));
            if (next.from > last.from) break;
            parabolas_.pop_back();
            next.from = -std::numeric_limits<double>::infinity();
        }
        parabolas_.push_back(next);
    }

    std::vector<Parabola> parabolas_;
};

}  // namespace

DistanceTransform distance_transform(const Index3& size, const Vec3& spacing, std::span<const std::uint8_t> marked,
                                     const Work& work) {
    DistanceTransform transform{std::vector<float>(marked.size()), std::vector<std::uint32_t>(marked.size())};
    for (std::size_t n = 0; n < marked.size(); ++n) {
        transform.distances[n] = marked[n] ? 0 : kFar;
        transform.nearest[n] = static_cast<std::uint32_t>(n);
    }
    const auto ni = static_cast<std::size_t>(size.i), nj = static_cast<std::size_t>(size.j),
               nk = static_cast<std::size_t>(size.k);
    // Lines that lie beside each other in memory are handled by one thread, one after the other.
    const auto along = [&](std::size_t lines, std::size_t count, std::size_t step, double apart, const auto& first) {
        parallel_for(static_cast<std::int64_t>(lines), 64, work, [&](std::int64_t begin, std::int64_t end) {
            Envelope envelope(count);
            for (auto line = static_cast<std::size_t>(begin); line < static_cast<std::size_t>(end); ++line)
                envelope.apply(&transform.distances[first(line)], &transform.nearest[first(line)], count, step, apart);
        });
    };
    along(nj * nk, ni, 1, spacing.x, [&](std::size_t line) { return line * ni; });
    along(ni * nk, nj, ni, spacing.y, [&](std::size_t line) { return line / ni * ni * nj + line % ni; });
    along(ni * nj, nk, ni * nj, spacing.z, [&](std::size_t line) { return line; });
    for (float& distance : transform.distances) distance = std::sqrt(distance);
    return transform;
}

DistanceTransform distance_transform(const Index3& size, std::span<const std::uint8_t> marked) {
    Work alone;
    alone.threads = 1;
    return distance_transform(size, {1, 1, 1}, marked, alone);
}

}  // namespace kontur
