// SPDX-License-Identifier: Apache-2.0
#include "kontur/volume_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/counted.h"

namespace kontur {
namespace {

// Behind each: how many of the true volumes lie within, between whole moments and where something was carried, of 24 made-up
// bodies with seven drawings each, where these make .906 and .939; of 24 others .883 and .910 (bench/moving_intervals.py).
constexpr double kOfDifference = 0.3;  // of what differs between two moments, half of the way. .15 .846, .921; .6 .951, .946
constexpr double kOfTime = 0.2;        // of the volume, half of the way round a cycle. .1 .841, .923; .4 .962, .949
constexpr double kOfCarried = 0.13;    // of what differs between any, if all was carried. .065 .906, .844; .26 .906, .986

}  // namespace

std::optional<FractionInterval> VolumeCurve::ejection_interval() const {
    if (intervals.empty() || !(volumes_ml[smallest] > 0)) return std::nullopt;
    VolumeInterval least = intervals.front(), most = least;  // the true extremes may be those of other frames
    for (const VolumeInterval& one : intervals) {
        least = {std::min(least.low_ml, one.low_ml), std::min(least.high_ml, one.high_ml)};
        most = {std::max(most.low_ml, one.low_ml), std::max(most.high_ml, one.high_ml)};
    }
    const double ratio = volumes_ml[smallest] / volumes_ml[largest];
    const double up =
        std::hypot(std::log(least.high_ml / volumes_ml[smallest]), std::log(volumes_ml[largest] / most.low_ml));
    const double down =
        std::hypot(std::log(volumes_ml[smallest] / least.low_ml), std::log(most.high_ml / volumes_ml[largest]));
    return FractionInterval{std::clamp(1 - ratio * std::exp(up), 0.0, 1.0),
                            std::clamp(1 - ratio * std::exp(-down), 0.0, 1.0)};
}

VolumeCurve volume_curve(std::vector<double> volumes_ml, std::vector<VolumeInterval> intervals) {
    VolumeCurve curve{std::move(volumes_ml), std::move(intervals)};
    const auto begin = curve.volumes_ml.begin(), end = curve.volumes_ml.end();
    curve.smallest = static_cast<std::size_t>(std::min_element(begin, end) - begin);
    curve.largest = static_cast<std::size_t>(std::max_element(begin, end) - begin);
    return curve;
}

std::string note_of_ties(const VolumeCurve& curve) {
    std::string note;
    for (const auto& [what, at] : {std::pair("largest", curve.largest), std::pair("smallest", curve.smallest)}) {
        const double ml = curve.volumes_ml[at];
        const auto count = std::count(curve.volumes_ml.begin(), curve.volumes_ml.end(), ml);
        if (count < 2) continue;
        note += fmt::format("{}the volume is {} in {}, of which frame {} is the first", note.empty() ? "" : "; ", what,
                            counted(static_cast<std::size_t>(count), "frame"), at + 1);
    }
    return note;
}

std::vector<MomentSureness> sureness_of(const std::vector<DrawnMoment>& moments) {
    std::vector<MomentSureness> all;
    for (const DrawnMoment& moment : moments) {
        const SurfaceUncertainty& known = moment.segmentation.report.uncertainty;
        if (!known.is_known || !(known.volume_ml > 0)) return {};
        const auto carried = static_cast<double>(moment.carried);
        all.push_back({known.volume_low_ml / known.volume_ml, known.volume_high_ml / known.volume_ml,
                       carried / (carried + static_cast<double>(moment.contours))});
    }
    return all;
}

std::vector<VolumeInterval> volume_intervals(const MaskCourse& course, const std::vector<MomentSureness>& moments,
                                             std::span<const double> times, const std::vector<double>& volumes_ml) {
    std::vector<VolumeInterval> intervals;
    if (moments.empty()) return intervals;
    const double of_all_ml = course.differing_ml();
    for (std::size_t n = 0; n < times.size(); ++n) {
        const TimeCourse::Place place = course.course().place_of(times[n]);
        const MomentSureness &before = moments[place.before], &after = moments[place.after];
        const double part = course.course().part_of(place), ml = volumes_ml[n];
        const double between_ml = 4 * part * (1 - part) *
                                  (kOfDifference * course.differing_ml(place.before, place.after) +
                                   kOfTime * ml * course.course().share_of_cycle(place));
        const double carried_ml = kOfCarried * std::lerp(before.carried, after.carried, part) * of_all_ml;
        const auto width = [&](double of_surface_ml) { return std::hypot(of_surface_ml, between_ml, carried_ml); };
        intervals.push_back({std::max(0.0, ml - width(ml * (1 - std::lerp(before.low, after.low, part)))),
                             ml + width(ml * (std::lerp(before.high, after.high, part) - 1))});
    }
    return intervals;
}

std::string volumes_csv(const std::vector<double>& times, const VolumeCurve& curve, const std::vector<DrawnMoment>& moments,
                        const std::optional<double>& step_s) {
    std::string text = "frame,time_s,volume_ml,contours,phase,low_ml,high_ml\n";
    for (std::size_t n = 0; n < times.size(); ++n) {
        std::size_t contours = 0;
        for (const DrawnMoment& moment : moments) contours += moment.time == times[n] ? moment.contours : 0;
        const char* phase = n == curve.largest ? "largest" : n == curve.smallest ? "smallest" : "";
        const std::string interval =
            curve.intervals.empty() ? ","
                                    : fmt::format("{:.3f},{:.3f}", curve.intervals[n].low_ml, curve.intervals[n].high_ml);
        text += fmt::format("{},{},{:.3f},{},{},{}\n", n + 1,
                            step_s ? fmt::format("{:g}", static_cast<double>(n) * *step_s) : "", curve.volumes_ml[n],
                            contours, phase, interval);
    }
    return text;
}

}  // namespace kontur
