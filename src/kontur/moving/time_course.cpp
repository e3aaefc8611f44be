// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/time_course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"

namespace kontur {
namespace {

// Mean Dice at frames left out of five bodies, 2, 3 and 5 whole frames (bench/moving.py); linear .9287, .9556, .9695, these
// .9301, .9601, .9758.
constexpr double kMostRate = 2;       // times the smaller rate beside a moment. 1 .9301, .9593, .9716; more overshoots
constexpr double kLeastWidth = 0.25;  // of the shorter interval, at a turning point. .125 .9301, .9591, .9745
constexpr double kMostWidth = 0.5;    // ... and where the rate stays the same. .25 .9301, .9596, .9747; more overlaps

/// The inverse of a small matrix, row by row, whose diagonal dominates.
std::vector<double> inverse(std::vector<double> a, std::size_t n) {
    std::vector<double> b(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) b[i * n + i] = 1;
    for (std::size_t k = 0; k < n; ++k) {
        const double pivot = 1 / a[k * n + k];
        for (std::size_t j = 0; j < n; ++j) {
            a[k * n + j] *= pivot;
            b[k * n + j] *= pivot;
        }
        for (std::size_t i = 0; i < n; ++i) {
            const double factor = a[i * n + k];
            if (i == k || factor == 0) continue;
            for (std::size_t j = 0; j < n; ++j) {
                a[i * n + j] -= factor * a[k * n + j];
                b[i * n + j] -= factor * b[k * n + j];
            }
        }
    }
    return b;
}

}  // namespace

TimeCourse::TimeCourse(std::vector<double> times, std::optional<double> cycle)
    : times_(std::move(times)), cycle_(std::move(cycle)) {
    const std::size_t n = times_.size();
    const auto refuse = [](const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); };
    if (n == 0) refuse("there is no moment; at least 1 is needed");
    for (std::size_t i = 0; i < n; ++i) {
        if (!std::isfinite(times_[i])) refuse(fmt::format("moment {} is at {:g}, which is no time", i + 1, times_[i]));
        if (i > 0 && !(times_[i] > times_[i - 1]))
            refuse(fmt::format("moment {} is at {:g}, not after {:g}; times have to rise", i + 1, times_[i], times_[i - 1]));
    }
    const double span = times_.back() - times_.front();
    if (cycle_ && !(std::isfinite(*cycle_) && *cycle_ > span))
        refuse(fmt::format("the cycle is {:g} long, and the moments span {:g}; they have to lie within one", *cycle_, span));
    for (std::size_t i = 0; i < n; ++i)
        lengths_.push_back(i + 1 < n ? times_[i + 1] - times_[i] : cycle_ ? *cycle_ - span : 0.0);
    if (n == 1) return;
    // The spline's rates r: h_i r_(i-1) + 2 (h_(i-1) + h_i) r_i + h_(i-1) r_(i+1) = 3 (h_i D_(i-1) + h_(i-1) D_i).
    std::vector<double> left(n * n, 0.0), right(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (!cycle_ && (i == 0 || i + 1 == n)) {
            left[i * n + i] = 1;  // at rest
            continue;
        }
        const double before = lengths_[previous(i)], after = lengths_[i];
        left[i * n + previous(i)] += after;
        left[i * n + i] += 2 * (before + after);
        left[i * n + next(i)] += before;
        right[i * n + previous(i)] -= 3 * after / before;
        right[i * n + i] += 3 * (after / before - before / after);
        right[i * n + next(i)] += 3 * before / after;
    }
    const std::vector<double> solved = inverse(left, n);
    rates_.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t j = 0; j < n; ++j) rates_[i * n + j] += solved[i * n + k] * right[k * n + j];
}

TimeCourse::Place TimeCourse::place_of(double time) const {
    if (!std::isfinite(time)) throw Error(ErrorKind::invalid_input, fmt::format("the time {:g} is not finite", time));
    if (cycle_) {
        time -= std::floor((time - times_.front()) / *cycle_) * *cycle_;
        if (time >= times_.front() + *cycle_) time = times_.front();  // by rounding
    }
    if (times_.size() == 1 || time <= times_.front()) return {0, 0, 0};
    if (!cycle_ && time >= times_.back()) return {times_.size() - 1, times_.size() - 1, 0};
    const auto behind = std::upper_bound(times_.begin(), times_.end(), time);
    const auto before = static_cast<std::size_t>(behind - times_.begin()) - 1;
    if (time == times_[before]) return {before, before, 0};
    return {before, next(before), time - times_[before]};
}

TimeCourse::Bend TimeCourse::bend(std::size_t moment, std::span<const double> values) const {
    const std::size_t n = times_.size();
    if (!cycle_ && (moment == 0 || moment + 1 == n)) return {0, kLeastWidth * lengths_[moment == 0 ? 0 : n - 2]};
    const std::size_t last = previous(moment);
    const double before = (values[moment] - values[last]) / lengths_[last];
    const double after = (values[next(moment)] - values[moment]) / lengths_[moment];
    const double shorter = std::min(lengths_[last], lengths_[moment]);
    if (!(before * after > 0)) return {0, kLeastWidth * shorter};
    double spline = 0;
    for (std::size_t k = 0; k < n; ++k) spline += rates_[moment * n + k] * values[k];
    const double sign = after > 0 ? 1 : -1;
    const double rate = std::clamp(sign * spline, 0.0, kMostRate * std::min(std::abs(before), std::abs(after)));
    const double steadiness = std::min(1.0, rate / std::max(std::abs(before), std::abs(after)));
    return {sign * rate, std::lerp(kLeastWidth, kMostWidth, steadiness) * shorter};
}

double TimeCourse::value(const Place& place, std::span<const double> values) const {
    if (place.before == place.after) return values[place.before];
    const Bend first = bend(place.before, values), second = bend(place.after, values);
    const double length = lengths_[place.before], rise = values[place.after] - values[place.before];
    const double between = (rise - 0.5 * (first.rate * first.width + second.rate * second.width)) /
                           (length - 0.5 * (first.width + second.width));
    const double left = length - place.since;
    if (left < second.width)
        return values[place.after] - second.rate * left - 0.5 * (between - second.rate) * left * left / second.width;
    const double bent = std::min(place.since, first.width);
    return values[place.before] + first.rate * bent + 0.5 * (between - first.rate) * bent * bent / first.width +
           between * (place.since - bent);
}

}  // namespace kontur
