// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_moving.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/base/smallest_ball.h"
#include "kontur/base/stopwatch.h"
#include "kontur/moving/carried_sections.h"
#include "kontur/moving/mesh_course.h"
#include "kontur/moving/moments.h"
#include "kontur/shape/provenance.h"

namespace kontur {
namespace {

constexpr double kFrameMeshSpacing = 0.01;  // of the diameter of what was drawn

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

/// The motion between moments as far as they stand for themselves.
WholeMotion whole_motion(const DrawnMoments& drawn, const std::vector<DrawnMoment>& alone) {
    std::vector<std::optional<ImplicitFunction>> functions(alone.size());
    for (std::size_t k = 0; k < alone.size(); ++k)
        if (drawn.weights[k] > 0) functions[k] = alone[k].segmentation.function;
    return {drawn.moments.course, functions, drawn.weights};
}

std::string moment_name(const Moments& moments, double time) {
    return moments.in_seconds ? fmt::format("at {:g} s", time) : fmt::format("frame {:g}", time);
}

std::vector<std::string> warnings_of(const Moments& moments, const std::vector<DrawnMoment>& fits) {
    std::vector<std::string> warnings;
    std::size_t carried = 0, moments_with = 0;
    for (const DrawnMoment& moment : fits) {
        carried += moment.carried;
        moments_with += moment.carried > 0;
        if (fits.size() == 1) continue;
        for (const std::string& warning : moment.segmentation.report.warnings)
            warnings.push_back(moment_name(moments, moment.time) + ": " + warning);
    }
    if (fits.size() == 1) warnings = fits.front().segmentation.report.warnings;
    if (carried > 0)
        warnings.push_back(fmt::format("at {} little was drawn; {} in planes drawn at others follow from those",
                                       counted(moments_with, "moment"), counted(carried, "section")));
    if (fits.size() > 1 && !moments.course.cycle())
        warnings.push_back("nothing moves before the first and after the last drawn moment; --cycle says when it repeats");
    return warnings;
}

/// The masks of a moving object at all times.
std::vector<Mask> masks_at(std::span<const double> times, const MaskCourse& course, const Work& work) {
    std::vector<Mask> masks(times.size());
    parallel_for(static_cast<std::int64_t>(times.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            masks[n] = course.at(times[n]);
    });
    return masks;
}

std::vector<TriangleMesh> meshes_at(std::span<const double> times, const MeshCourse& course, const Work& work) {
    std::vector<TriangleMesh> meshes(times.size());
    parallel_for(static_cast<std::int64_t>(times.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            meshes[n] = course.at(times[n]);
    });
    return meshes;
}

}  // namespace

MaskCourse MovingFit::mask_course(const Work& work) const {
    std::vector<Mask> masks;
    for (const DrawnMoment& moment : moments) masks.push_back(moment.segmentation.mask);
    return {function, std::move(masks), work};
}

MeshCourse MovingFit::mesh_course(const Work& work) const {
    const std::vector<std::vector<Vec3>> points = starts();
    std::vector<Vec3> all;
    for (const std::vector<Vec3>& some : points) all.insert(all.end(), some.begin(), some.end());
    return {function, points, kFrameMeshSpacing * smallest_ball(all).diameter(), work};
}

std::vector<std::vector<Vec3>> MovingFit::starts() const {
    std::vector<std::vector<Vec3>> all;
    for (const DrawnMoment& moment : moments) {
        std::vector<Vec3>& points = all.emplace_back();
        for (const Contour& contour : moment.set.contours)
            points.insert(points.end(), contour.points.begin(), contour.points.end());
    }
    return all;
}

DrawnMoment MovingFitter::fitted(ContourSet set, double time, bool follows_image, const Work& work) const {
    const std::string digest = contours_sha256(set);
    const bool asks_image = follows_image && frames_.image_at && options_.use_image != UseImage::off;
    for (const DrawnMoment& known : known_) {
        const bool asked_image = known.segmentation.report.image.verdict != ImageVerdict::none;
        if (asked_image == asks_image && (!asks_image || known.time == time) && contours_sha256(known.set) == digest)
            return known;
    }
    const std::shared_ptr<const Image> image = asks_image ? frames_.image_at(time) : nullptr;
    DrawnMoment moment;
    moment.segmentation = segment(set, frames_.grid, image.get(), options_, work.untold());
    moment.set = std::move(set);
    return moment;
}

MovingFit MovingFitter::fit(const ContourSet& drawn_contours, std::span<const double> times, const Work& work) {
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch watch(seconds);
    Moments moments = moments_or_rest(drawn_contours);
    check(drawn_contours, moments, times);
    const ContourSet contours = in_order_of_time(drawn_contours, moments);
    DrawnMoments drawn = drawn_moments(contours, moments);
    std::vector<DrawnMoment> fits(drawn.sets.size());
    const auto fit_moment = [&](std::size_t k, std::size_t carried) {
        work.report("segment moments", static_cast<double>(k) / static_cast<double>(fits.size()));
        const double time = moments.course.times()[k];
        fits[k] = fitted(drawn.sets[k], time, drawn.weights[k] == 1, work);
        fits[k].time = time;
        fits[k].carried = carried;
        fits[k].contours = fits[k].set.contours.size() - carried;
    };
    for (std::size_t k = 0; k < fits.size(); ++k)
        if (drawn.weights[k] > 0) fit_moment(k, 0);
    watch.lap("whole moments");
    const std::vector<DrawnMoment> alone = fits;
    const std::vector<std::vector<Contour>> carried =
        carried_sections(contours, drawn, whole_motion(drawn, alone), options_.fill_rule, work);
    watch.lap("carry sections");
    for (std::size_t k = 0; k < fits.size(); ++k) {
        if (drawn.weights[k] == 1 || (drawn.weights[k] > 0 && carried[k].empty())) continue;
        drawn.sets[k].contours.insert(drawn.sets[k].contours.end(), carried[k].begin(), carried[k].end());
        fit_moment(k, carried[k].size());
    }
    watch.lap("other moments");
    known_ = fits;
    for (std::size_t k = 0; k < fits.size(); ++k)
        if (fits[k].carried > 0 && drawn.weights[k] > 0) known_.push_back(alone[k]);
    std::vector<ImplicitFunction> functions;
    for (const DrawnMoment& moment : fits) functions.push_back(moment.segmentation.function);
    MovingFunction function(moments.course, std::move(functions));
    std::vector<std::string> warnings = warnings_of(moments, fits);
    return {std::move(function), std::move(fits), std::move(warnings), std::move(seconds)};
}

MovingSegmentation segment_moving(const ContourSet& contours, const FramesToSegment& frames, std::span<const double> times,
                                  const SegmentOptions& options, const Work& work) {
    SegmentOptions by_contours = options;
    by_contours.mesh = false;
    MovingFit fit = MovingFitter(frames, by_contours).fit(contours, times, work);
    Stopwatch watch(fit.seconds);
    const MaskCourse course = fit.mask_course(work);
    std::vector<Mask> masks = masks_at(times, course, work);
    std::vector<double> volumes;
    for (const Mask& mask : masks) volumes.push_back(volume_ml(mask));
    std::vector<VolumeInterval> intervals = volume_intervals(course, sureness_of(fit.moments), times, volumes);
    VolumeCurve curve = volume_curve(std::move(volumes), std::move(intervals));
    if (std::string note = note_of_ties(curve); !note.empty()) fit.warnings.push_back(std::move(note));
    watch.lap("voxelize");
    std::vector<TriangleMesh> meshes;
    if (options.mesh) meshes = meshes_at(times, fit.mesh_course(work), work);
    if (options.mesh) watch.lap("polygonize");
    return {{times.begin(), times.end()}, std::move(masks), std::move(meshes),       std::move(fit.function),
            std::move(fit.moments),       std::move(curve), std::move(fit.warnings), std::move(fit.seconds)};
}

}  // namespace kontur
