// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_moving.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/base/stopwatch.h"
#include "kontur/moving/carried_sections.h"
#include "kontur/moving/moments.h"

namespace kontur {
namespace {

void check(const ContourSet& contours, const Moments& moments, std::span<const double> times) {
    if (const std::vector<std::string> problems = contour_problems(contours); !problems.empty())
        throw Error(ErrorKind::invalid_input, problems.front());
    if (times.empty()) throw Error(ErrorKind::invalid_input, "there is no time to make a mask at; at least 1 is needed");
    if (moments.course.times().size() < 2) return;
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    for (std::size_t k = 0; k < moments.contours.size(); ++k)
        if (const double time = moments.course.times()[k]; !(time >= *first && time <= *last))
            throw Error(
                ErrorKind::invalid_input,
                fmt::format("contour {} lies at {} {:g}, and the image's frames go from {:g} to {:g}",
                            moments.contours[k].front() + 1, moments.in_seconds ? "time_s" : "frame", time, *first, *last));
}

/// The moments at which it was drawn, a single one at which nothing moves.
Moments moments_or_rest(const ContourSet& set) {
    if (set.contours.empty() || is_moving(set)) return moments_of(set);
    std::vector<std::size_t> all(set.contours.size());
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = n;
    const Contour& contour = set.contours.front();
    const double time = contour.time_s ? *contour.time_s : contour.frame.value_or(1);
    return {contour.time_s.has_value(), TimeCourse({time}), {all}};
}

/// The contours of the earliest moment first, so that the order in which they came does not matter; renumbers the moments'.
ContourSet in_order_of_time(const ContourSet& set, Moments& moments) {
    ContourSet ordered = set;
    ordered.contours.clear();
    for (std::vector<std::size_t>& at : moments.contours)
        for (std::size_t& n : at) {
            ordered.contours.push_back(set.contours[n]);
            n = ordered.contours.size() - 1;
        }
    return ordered;
}

/// The motion between whole moments.
std::optional<MovingFunction> between_whole(const Moments& moments, const DrawnMoments& drawn,
                                            const std::vector<DrawnMoment>& made) {
    std::vector<double> times;
    std::vector<ImplicitFunction> functions;
    for (std::size_t k = 0; k < made.size(); ++k)
        if (drawn.is_whole[k]) {
            times.push_back(made[k].time);
            functions.push_back(made[k].segmentation.function);
        }
    if (times.empty()) return std::nullopt;
    return MovingFunction(TimeCourse(std::move(times), moments.course.cycle()), std::move(functions));
}

/// Masks at all times. What is inside at two moments, or outside, stays so between them; so f is computed where the moments'
/// masks differ, and only there.
class MaskCourse {
public:
    MaskCourse(const MovingFunction& function, const std::vector<DrawnMoment>& moments, const Work& work)
        : course_(function.course()), moments_(moments) {
        const Mask& first = moments.front().segmentation.mask;
        std::vector<Vec3> places;
        for (std::size_t v = 0; v < first.values.size(); ++v) {
            const auto differs = [&](const DrawnMoment& m) { return m.segmentation.mask.values[v] != first.values[v]; };
            if (std::none_of(moments.begin(), moments.end(), differs)) continue;
            voxels_.push_back(v);
            const Index3 at = index_at(v, first.grid.size);
            places.push_back(first.grid.center_mm(at.i, at.j, at.k));
        }
        std::vector<double> values(places.size());
        values_.resize(places.size() * moments.size());
        for (std::size_t k = 0; k < moments.size(); ++k) {
            work.report("values between moments", static_cast<double>(k) / static_cast<double>(moments.size()));
            function.functions()[k].values(places, values, work.untold());
            for (std::size_t n = 0; n < places.size(); ++n) {
                // A sheet that no contour touches is not in the mask, whatever f says.
                const bool is_inside = moments[k].segmentation.mask.values[voxels_[n]] != 0;
                if (is_inside != (values[n] > 0)) values[n] = is_inside ? std::numeric_limits<double>::min() : 0.0;
                values_[n * moments.size() + k] = values[n];
            }
        }
    }

    Mask at(double time) const {
        const TimeCourse::Place place = course_.place_of(time);
        Mask mask = moments_[place.before].segmentation.mask;
        if (place.before == place.after) return mask;
        for (std::size_t n = 0; n < voxels_.size(); ++n) {
            const std::span<const double> values(&values_[n * moments_.size()], moments_.size());
            if ((values[place.before] > 0) != (values[place.after] > 0))
                mask.values[voxels_[n]] = course_.value(place, values) > 0;
        }
        return mask;
    }

private:
    const TimeCourse& course_;
    const std::vector<DrawnMoment>& moments_;
    std::vector<std::size_t> voxels_;  ///< in which moments differ
    std::vector<double> values_;       ///< of each of them f at all moments
};

VolumeCurve volumes_of(const std::vector<Mask>& masks) {
    VolumeCurve curve;
    for (const Mask& mask : masks) {
        const auto voxels = std::count_if(mask.values.begin(), mask.values.end(), [](auto v) { return v != 0; });
        curve.volumes_ml.push_back(static_cast<double>(voxels) * mask.grid.voxel_volume_mm3() / 1000);
    }
    const auto [least, most] = std::minmax_element(curve.volumes_ml.begin(), curve.volumes_ml.end());
    curve.smallest = static_cast<std::size_t>(least - curve.volumes_ml.begin());
    curve.largest = static_cast<std::size_t>(std::find(curve.volumes_ml.begin(), curve.volumes_ml.end(), *most) -
                                             curve.volumes_ml.begin());
    return curve;
}

std::string moment_name(const Moments& moments, double time) {
    return moments.in_seconds ? fmt::format("at {:g} s", time) : fmt::format("frame {:g}", time);
}

std::vector<std::string> warnings_of(const Moments& moments, const std::vector<DrawnMoment>& made) {
    std::vector<std::string> warnings;
    std::size_t carried = 0, moments_with = 0;
    for (const DrawnMoment& moment : made) {
        carried += moment.carried;
        moments_with += moment.carried > 0;
        if (made.size() == 1) continue;
        for (const std::string& warning : moment.segmentation.report.warnings)
            warnings.push_back(moment_name(moments, moment.time) + ": " + warning);
    }
    if (made.size() == 1) warnings = made.front().segmentation.report.warnings;
    if (carried > 0)
        warnings.push_back(fmt::format("at {} little was drawn; {} in planes drawn at others follow from those",
                                       counted(moments_with, "moment"), counted(carried, "section")));
    if (made.size() > 1 && !moments.course.cycle())
        warnings.push_back("nothing moves before the first and after the last drawn moment; --cycle says when it repeats");
    return warnings;
}

}  // namespace

MovingSegmentation segment_moving(const ContourSet& drawn_contours, const Grid& grid, std::span<const double> times,
                                  const SegmentOptions& options, const Work& work) {
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch watch(seconds);
    Moments moments = moments_or_rest(drawn_contours);
    check(drawn_contours, moments, times);
    const ContourSet contours = in_order_of_time(drawn_contours, moments);
    DrawnMoments drawn = drawn_moments(contours, moments);
    SegmentOptions by_contours = options;
    by_contours.mesh = false;

    std::vector<DrawnMoment> made(drawn.sets.size());
    const auto segment_moment = [&](std::size_t k) {
        work.report("segment moments", static_cast<double>(k) / static_cast<double>(made.size()));
        made[k].segmentation = segment(drawn.sets[k], grid, by_contours, work.untold());
    };
    for (std::size_t k = 0; k < made.size(); ++k) {
        made[k].time = moments.course.times()[k];
        made[k].contours = drawn.sets[k].contours.size();
        if (drawn.is_whole[k]) segment_moment(k);
    }
    watch.lap("whole moments");
    const std::optional<MovingFunction> whole = between_whole(moments, drawn, made);
    const std::vector<std::vector<Contour>> carried =
        carried_sections(contours, drawn, whole ? &*whole : nullptr, options.fill_rule, work);
    watch.lap("carry sections");
    for (std::size_t k = 0; k < made.size(); ++k) {
        if (drawn.is_whole[k]) continue;
        made[k].carried = carried[k].size();
        drawn.sets[k].contours.insert(drawn.sets[k].contours.end(), carried[k].begin(), carried[k].end());
        segment_moment(k);
    }
    watch.lap("other moments");

    std::vector<ImplicitFunction> functions;
    for (const DrawnMoment& moment : made) functions.push_back(moment.segmentation.function);
    MovingSegmentation result{
        {times.begin(), times.end()}, {}, MovingFunction(moments.course, std::move(functions)), {}, {}, {}, {}};
    const MaskCourse masks(result.function, made, work);
    result.masks.resize(times.size());
    parallel_for(static_cast<std::int64_t>(times.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            result.masks[n] = masks.at(times[n]);
    });
    watch.lap("voxelize");
    result.volumes = volumes_of(result.masks);
    result.warnings = warnings_of(moments, made);
    result.moments = std::move(made);
    result.seconds = std::move(seconds);
    return result;
}

}  // namespace kontur
