// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/times_of_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

constexpr double kSameFrame = 0.01;  // of a frame

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

/// Seconds become frames, which may lie between two.
void turn_seconds_into_frames(ContourSet& set, const FramesOfImage& frames) {
    for (std::size_t n = 0; n < set.contours.size(); ++n) {
        Contour& contour = set.contours[n];
        if (!contour.time_s) continue;
        if (!frames.step_s || !(*frames.step_s > 0))
            refuse(
                fmt::format("contour {} has a time_s, and the image does not say how far apart its frames are; give "
                            "contours a frame",
                            n + 1));
        contour.frame = 1 + *contour.time_s / *frames.step_s;
        contour.time_s.reset();
    }
    if (set.cycle_s && frames.step_s) set.cycle_frames = *set.cycle_s / *frames.step_s;
    set.cycle_s.reset();
}

}  // namespace

std::vector<std::string> put_into_frames(ContourSet& set, const FramesOfImage& frames) {
    if (frames.count < 2) {
        const auto moment = [](const Contour& contour) { return std::pair(contour.frame, contour.time_s); };
        const auto is_first = [&](const Contour& contour) { return moment(contour) == moment(set.contours.front()); };
        if (!std::ranges::all_of(set.contours, is_first))
            refuse("contours were drawn at several moments, and the image has 1 frame; open the image that has all of them");
        for (Contour& contour : set.contours) contour.frame.reset(), contour.time_s.reset();
        return {};
    }
    turn_seconds_into_frames(set, frames);
    std::size_t count = 0;
    for (std::size_t n = 0; n < set.contours.size(); ++n) {
        std::optional<double>& frame = set.contours[n].frame;
        if (!frame) continue;
        const double nearest = std::round(*frame);
        if (!(nearest >= 1 && nearest <= frames.count))
            refuse(fmt::format("contour {} lies in frame {:g}, and the image's frames go from 1 to {}", n + 1, *frame,
                               frames.count));
        count += std::abs(nearest - *frame) > kSameFrame;
        frame = nearest;
    }
    if (count == 0) return {};
    return {fmt::format("{} between two frames {} moved to the nearer one", counted(count, "contour"),
                        count == 1 ? "was" : "were")};
}

std::optional<int> time_of(const Contour& contour, const FramesOfImage& frames) {
    if (!contour.frame) return std::nullopt;
    const int time = static_cast<int>(*contour.frame) - 1;
    return time == frames.opened ? std::nullopt : std::optional(time);
}

}  // namespace kontur::viewer
