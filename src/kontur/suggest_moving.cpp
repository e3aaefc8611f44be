// SPDX-License-Identifier: Apache-2.0
#include "kontur/suggest_moving.h"

#include <algorithm>
#include <cmath>

#include "kontur/sampling/drawn_lines.h"
#include "kontur/suggest.h"

namespace kontur {
namespace {

constexpr double kStill = 0.01;  // of the size: by so much a surface counts that does not move

/// What was drawn at a moment, without what stands for other contours.
ContourSet drawn_at(const DrawnMoment& moment) {
    ContourSet set = moment.set;
    set.contours.resize(moment.contours);
    return set;
}

const DrawnMoment* moment_at(const MotionEvidence& evidence, double time) {
    const auto found = std::ranges::find(evidence.moments, time, &DrawnMoment::time);
    return found == evidence.moments.end() ? nullptr : &*found;
}

/// How little is known of each frame: how wide its volume's interval is.
std::vector<double> doubts_of(const MotionEvidence& evidence) {
    std::vector<double> doubts(evidence.times.size(), 0);
    for (std::size_t n = 0; n < doubts.size(); ++n) {
        if (!evidence.volumes.intervals.empty())
            doubts[n] = evidence.volumes.intervals[n].high_ml - evidence.volumes.intervals[n].low_ml;
        else if (const DrawnMoment* moment = moment_at(evidence, evidence.times[n]))
            doubts[n] = 1 / static_cast<double>(moment->contours);
    }
    return doubts;
}

double apart(double one, double other, const std::optional<double>& cycle) {
    const double direct = std::abs(one - other);
    return cycle ? std::min(direct, *cycle - direct) : direct;
}

/// From 0 at the frame to 1 as far away as a moment is, at most half of the way between the moments around.
void take_along(std::vector<double>& doubts, const MotionEvidence& evidence, std::size_t chosen) {
    const TimeCourse& course = evidence.function.course();
    const double at = evidence.times[chosen];
    double reach = 0;
    for (const double time : course.times()) {
        const double away = apart(at, time, course.cycle());
        if (reach == 0 || (away > 0 && away < reach)) reach = away;
    }
    for (std::size_t n = 0; n < doubts.size(); ++n) {
        const double away = apart(at, evidence.times[n], course.cycle());
        doubts[n] *= reach > 0 ? std::min(1.0, away / reach) : away > 0 ? 1 : 0;
    }
}

/// The planes in which something was drawn at other moments, and nothing at this one.
std::vector<Plane> planes_left(const MotionEvidence& evidence, const DrawnMoment* own) {
    ContourSet all;
    if (own) all = drawn_at(*own);
    const auto known = static_cast<std::ptrdiff_t>(DrawnLines(all).planes().size());
    for (const DrawnMoment& moment : evidence.moments)
        for (const Contour& contour : drawn_at(moment).contours) all.contours.push_back(contour);
    const DrawnLines lines(all);
    return {lines.planes().begin() + known, lines.planes().end()};
}

/// That of the planes in which the surface of one moment lies farthest from that of the other, summed along its outline.
std::optional<Plane> most_moved(const MotionEvidence& evidence, std::size_t frame, const std::vector<Plane>& planes,
                                const Work& work) {
    const TimeCourse::Place place = evidence.function.course().place_of(evidence.times[frame]);
    const SurfaceSamples& samples = evidence.moments[place.before].segmentation.samples;
    std::vector<double> away(samples.points.size());
    evidence.function.functions()[place.after].values(samples.points, away, work);
    double area = 0;
    for (const double one : samples.areas_mm2) area += one;
    const double size = std::sqrt(area), slab = 0.03 * size;
    std::optional<Plane> best;
    double most = 0;
    for (const Plane& plane : planes) {
        double sum = 0, weight = 0;
        Vec3 middle;
        for (std::size_t n = 0; n < away.size(); ++n) {
            if (std::abs(plane.distance_to(samples.points[n])) > slab) continue;
            sum += samples.areas_mm2[n] * (std::abs(away[n]) + kStill * size);
            weight += samples.areas_mm2[n];
            middle += samples.areas_mm2[n] * samples.points[n];
        }
        if (!(sum > most)) continue;
        most = sum;
        best = plane;
        best->origin = middle / weight - plane.distance_to(middle / weight) * plane.normal;
    }
    return best;
}

}  // namespace

std::vector<MovingSuggestion> suggest_moving(const MotionEvidence& evidence, std::size_t count,
                                             const SuggestPlaneOptions& options, const Work& work) {
    std::vector<double> doubts = doubts_of(evidence);
    std::vector<MovingSuggestion> found;
    while (found.size() < count) {
        const auto most = std::ranges::max_element(doubts);
        if (most == doubts.end() || !(*most > 0)) break;
        const auto frame = static_cast<std::size_t>(most - doubts.begin());
        const DrawnMoment* own = moment_at(evidence, evidence.times[frame]);
        const std::vector<Plane> left = planes_left(evidence, own);
        if (const auto plane = most_moved(evidence, frame, left, work)) {
            found.push_back({frame, *plane});
        } else if (own) {
            const ContourSet drawn = drawn_at(*own);
            for (const SuggestedPlane& one : suggest_planes(own->segmentation, drawn, 1, options, work).planes)
                found.push_back({frame, one.plane, one.slice});
        }
        take_along(doubts, evidence, frame);
    }
    return found;
}

}  // namespace kontur
