// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving_sureness.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/suggest.h"

namespace kontur {
namespace {

// Behind each: how much of the surface lies within between whole moments, and between such with carried sections, of 8
// made-up bodies with seven drawings each, where these make .904 and .945 (bench/moving_intervals.py --band).
// Of how far the surface moves between two moments, half of the way. .15 .872, .928; .6 .930, .959.
constexpr double kOfDistance = 0.3;
// Of its size, half of the way round a cycle. .01 .876, .935; .04 .938, .957.
constexpr double kOfTime = 0.02;

double size_of(const DrawnMoment& moment) {
    const std::vector<double>& areas = moment.segmentation.samples.areas_mm2;
    return std::sqrt(std::accumulate(areas.begin(), areas.end(), 0.0));
}

}  // namespace

std::vector<double> half_widths_mm(const MovingFunction& function, const std::vector<DrawnMoment>& moments,
                                   const std::vector<Vec3>& points, double time, const Work& work) {
    const TimeCourse& course = function.course();
    const TimeCourse::Place place = course.place_of(time);
    const DrawnMoment &before = moments[place.before], &after = moments[place.after];
    std::vector<double> widths = half_widths_mm(before.segmentation, before.set, points, work);
    const std::vector<double> later =
        place.before == place.after ? widths : half_widths_mm(after.segmentation, after.set, points, work);
    if (widths.size() != points.size() || later.size() != points.size()) return {};
    if (place.before == place.after) return widths;
    std::vector<double> before_values(points.size()), after_values(points.size());
    function.functions()[place.before].values(points, before_values, work);
    function.functions()[place.after].values(points, after_values, work);
    const double part = course.part_of(place), between = 4 * part * (1 - part);
    const double taken = kOfTime * course.share_of_cycle(place) * std::lerp(size_of(before), size_of(after), part);
    for (std::size_t n = 0; n < points.size(); ++n) {
        const double moved = std::abs(after_values[n] - before_values[n]);
        widths[n] = std::hypot(std::lerp(widths[n], later[n], part), between * (kOfDistance * moved + taken));
    }
    return widths;
}

}  // namespace kontur
