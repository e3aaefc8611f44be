// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"

// What moves: whether it repeats, and what pages are told of it.

namespace kontur::viewer {
namespace {

using nlohmann::json;

json set_cycle(SessionState& s, const Members& m) {
    if (s.image.times.count() < 2)
        throw Error(ErrorKind::invalid_input, "the image has 1 frame; at least 2 are needed for a motion that repeats");
    const std::optional<double> before = s.project.state().cycle_frames;
    const double after = m.flag("repeats") ? s.image.cycle_frames.value_or(s.image.times.count()) : 0;
    if (before == after) return json::object();
    Commit step{after > 0 ? "The motion repeats" : "The motion does not repeat", {}, {}};
    step.cycle = CycleChange{before, after};
    commit(s, step);
    return json::object();
}

}  // namespace

Calls motion_calls() { return {{"cycle.set", {set_cycle}}}; }

json cycle_json(const SessionState& s) {
    const auto& cycle = s.project.state().cycle_frames;
    return cycle ? json(*cycle) : json(nullptr);
}

json motion_json(const Motion& motion) {
    json told{{"structure", motion.structure}, {"finished", motion.is_finished}, {"warnings", motion.warnings}};
    told["revisions"] = json::array();
    for (const MotionFrame& frame : motion.frames) told["revisions"].push_back(frame.revision);
    if (!motion.volumes) return told;
    const VolumeCurve& curve = *motion.volumes;
    told["curve"] = {{"volumes_ml", curve.volumes_ml},
                     {"largest", curve.largest},
                     {"smallest", curve.smallest},
                     {"stroke_ml", curve.stroke_ml()},
                     {"ejection_fraction", curve.ejection_fraction()}};
    for (const VolumeInterval& one : curve.intervals) told["curve"]["intervals_ml"].push_back({one.low_ml, one.high_ml});
    if (const auto interval = curve.ejection_interval())
        told["curve"]["ejection_interval"] = {interval->low, interval->high};
    return told;
}

json motion_event(const Motion& motion) {
    json event = motion_json(motion);
    event["event"] = "motion";
    return event;
}

std::optional<int> time_from(const SessionState& s, std::optional<int> time) {
    const int count = s.image.times.count();
    if (time && *time >= count)
        throw Error(ErrorKind::invalid_input, fmt::format("there is no time {}: the last one is time {}", *time, count - 1));
    return time == s.image.times.own() ? std::nullopt : time;
}

void check_time(const SessionState& s, const Structure& structure, const DrawnContour& contour) {
    if (structure.mask && contour.time)
        throw Error(ErrorKind::invalid_input, fmt::format("{} is a mask of frame {}; it is corrected there, not in frame {}",
                                                          structure.name, s.image.times.own() + 1, *contour.time + 1));
}

}  // namespace kontur::viewer
