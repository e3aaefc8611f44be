// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kontur {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// The lower envelope of parabolas (x - q)^2 + value(q) along one line of a lattice.
class Envelope {
public:
    explicit Envelope(std::size_t most) { parabolas_.reserve(most); }

    /// Replaces `count` squared distances, `step` apart, by their least sums with squared distances along the line.
    void apply(float* squared, std::uint32_t* nearest, std::size_t count, std::size_t step) {
        parabolas_.clear();
        for (std::size_t q = 0; q < count; ++q)
            if (squared[q * step] != kFar) add({static_cast<double>(q), 0, squared[q * step], nearest[q * step]});
        if (parabolas_.empty()) return;
        std::size_t at = 0;
        for (std::size_t x = 0; x < count; ++x) {
            while (at + 1 < parabolas_.size() && parabolas_[at + 1].from < static_cast<double>(x)) ++at;
            const double apart = static_cast<double>(x) - parabolas_[at].place;
            squared[x * step] = static_cast<float>(apart * apart + parabolas_[at].value);
            nearest[x * step] = parabolas_[at].nearest;
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

NearestMarked nearest_marked(const Index3& size, std::span<const std::uint8_t> marked) {
    NearestMarked found{std::vector<float>(marked.size()), std::vector<std::uint32_t>(marked.size())};
    for (std::size_t n = 0; n < marked.size(); ++n) {
        found.steps[n] = marked[n] ? 0 : kFar;
        found.nearest[n] = static_cast<std::uint32_t>(n);
    }
    const auto ni = static_cast<std::size_t>(size.i), nj = static_cast<std::size_t>(size.j),
               nk = static_cast<std::size_t>(size.k);
    Envelope envelope(std::max({ni, nj, nk}));
    const auto apply = [&](std::size_t first, std::size_t count, std::size_t step) {
        envelope.apply(&found.steps[first], &found.nearest[first], count, step);
    };
    for (std::size_t row = 0; row < nj * nk; ++row) apply(row * ni, ni, 1);
    for (std::size_t k = 0; k < nk; ++k)
        for (std::size_t i = 0; i < ni; ++i) apply(k * ni * nj + i, nj, ni);
    for (std::size_t column = 0; column < ni * nj; ++column) apply(column, nk, ni * nj);
    for (float& steps : found.steps) steps = std::sqrt(steps);
    return found;
}

}  // namespace kontur
