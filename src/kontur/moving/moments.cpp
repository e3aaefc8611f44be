// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/moments.h"

#include <fmt/format.h>

#include <map>

#include "kontur/base/error.h"

namespace kontur {
namespace {

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

/// That of the contours' unit.
std::optional<double> cycle_of(const ContourSet& set, bool in_seconds) {
    if (in_seconds ? set.cycle_frames.has_value() : set.cycle_s.has_value())
        refuse(in_seconds
                   ? "contours have a time_s, and the cycle is in frames; it has to be in seconds, too (cycle_s)"
                   : "contours have a frame, and the cycle is in seconds; it has to be in frames, too (cycle_frames)");
    const std::optional<double>& cycle = in_seconds ? set.cycle_s : set.cycle_frames;
    if (cycle && !(*cycle > 0)) refuse(fmt::format("the cycle is {:g} long; it has to be longer than 0", *cycle));
    return cycle;
}

}  // namespace

Moments moments_of(const ContourSet& set) {
    if (set.contours.empty()) refuse("there is no contour; at least 1 is needed");
    const bool in_seconds = set.contours.front().time_s.has_value();
    const std::optional<double> cycle = cycle_of(set, in_seconds);
    const double first = in_seconds ? 0 : 1;
    std::map<double, std::vector<std::size_t>> at;
    for (std::size_t n = 0; n < set.contours.size(); ++n) {
        const Contour& contour = set.contours[n];
        const std::optional<double>& time = in_seconds ? contour.time_s : contour.frame;
        if (!time)
            refuse(fmt::format("contour {} has no {}, and contour 1 has {}; all or none have to have one", n + 1,
                               in_seconds ? "time_s" : "frame",
                               in_seconds       ? "one"
                               : contour.time_s ? "none"
                                                : "one"));
        if (cycle && !(*time >= first && *time < first + *cycle))
            refuse(fmt::format("contour {} lies at {} {:g}, and a cycle of {:g} goes from {:g} to before {:g}", n + 1,
                               in_seconds ? "time_s" : "frame", *time, *cycle, first, first + *cycle));
        at[*time].push_back(n);
    }
    std::vector<double> times;
    std::vector<std::vector<std::size_t>> contours;
    for (auto& [time, numbers] : at) {
        times.push_back(time);
        contours.push_back(std::move(numbers));
    }
    return {in_seconds, TimeCourse(std::move(times), cycle), std::move(contours)};
}

ContourSet at_moment(const ContourSet& set, const std::vector<std::size_t>& contours) {
    ContourSet some = set;
    some.contours.clear();
    some.cycle_frames.reset();
    some.cycle_s.reset();
    for (const std::size_t n : contours) {
        Contour& contour = some.contours.emplace_back(set.contours[n]);
        contour.frame.reset();
        contour.time_s.reset();
    }
    return some;
}

}  // namespace kontur
