// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving_sureness.h"

#include <cmath>
#include <utility>

#include "kontur/evidence.h"
#include "kontur/sureness/surface_uncertainty.h"

namespace kontur {
namespace {

// Behind each: how much of the surface lies within between whole moments, and between such with carried sections, of 8
// made-up bodies with seven drawings each, where these make .904 and .945 (bench/moving_intervals.py --band).
// Of how far the surface moves between two moments, half of the way. .15 .872, .928; .6 .930, .959.
constexpr double kOfDistance = 0.3;
// Of its size, half of the way round a cycle. .01 .876, .935; .04 .938, .957.
constexpr double kOfTime = 0.02;

double size_of(const SurfaceEvidence& moment) { return std::sqrt(moment.samples.area_mm2()); }

SurfaceEvidence evidence_of(const DrawnMoment& moment, const Work& work) {
    return gather_evidence(moment.segmentation, moment.set, work);
}

/// Between two moments.
struct Sides {
    const SurfaceEvidence &before, &after;
    double part;            ///< of the way from one to the other
    double share_of_cycle;  ///< that it takes
};

std::vector<double> widths_between(const Sides& sides, const std::vector<Vec3>& points,
                                   const std::vector<double>& changes_mm, const Work& work) {
    std::vector<double> widths = half_widths_mm(sides.before, points, work);
    const std::vector<double> later = half_widths_mm(sides.after, points, work);
    if (widths.size() != points.size() || later.size() != points.size()) return {};
    const double between = 4 * sides.part * (1 - sides.part);
    const double taken = kOfTime * sides.share_of_cycle * std::lerp(size_of(sides.before), size_of(sides.after), sides.part);
    for (std::size_t n = 0; n < points.size(); ++n)
        widths[n] = std::hypot(std::lerp(widths[n], later[n], sides.part), between * (kOfDistance * changes_mm[n] + taken));
    return widths;
}

}  // namespace

MovingSureness::MovingSureness(TimeCourse course, const std::vector<DrawnMoment>& moments, const Work& work)
    : course_(std::move(course)) {
    for (const DrawnMoment& moment : moments) moments_.push_back(evidence_of(moment, work));
}

std::vector<double> MovingSureness::half_widths_mm(const std::vector<Vec3>& points, const std::vector<double>& changes_mm,
                                                   double time, const Work& work) const {
    const TimeCourse::Place place = course_.place_of(time);
    const SurfaceEvidence& before = moments_[place.before];
    if (place.before == place.after) return kontur::half_widths_mm(before, points, work);
    return widths_between({before, moments_[place.after], course_.part_of(place), course_.share_of_cycle(place)}, points,
                          changes_mm, work);
}

std::vector<double> half_widths_mm(const MovingFunction& function, const std::vector<DrawnMoment>& moments,
                                   const std::vector<Vec3>& points, double time, const Work& work) {
    const TimeCourse& course = function.course();
    const TimeCourse::Place place = course.place_of(time);
    const SurfaceEvidence before = evidence_of(moments[place.before], work);
    if (place.before == place.after) return half_widths_mm(before, points, work);
    const SurfaceEvidence after = evidence_of(moments[place.after], work);
    return widths_between({before, after, course.part_of(place), course.share_of_cycle(place)}, points,
                          function.changes(points, time, work), work);
}

}  // namespace kontur
