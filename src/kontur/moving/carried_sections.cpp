// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/carried_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/extract/isolines.h"
#include "kontur/fit/prepare.h"
#include "kontur/fit/sides.h"
#include "kontur/moving/space_time.h"
#include "kontur/sampling/drawn_lines.h"

namespace kontur {
namespace {

// Behind some: mean Dice of 2 whole frames with a slice in 4 others, of 3 other slices in each of 5 frames and of 20 single
// slices, of 5 bodies (bench/moving.py), where these make .9679, .9692, .9826.
constexpr std::array kSpeeds{0.5, 0.75, 1.1, 1.7, 2.5};  // radii along time for a cycle, of which one is chosen
constexpr std::size_t kUsualSpeed = 3;                   // of these, where few contours could tell. 1 .9622, 2 .9653
constexpr double kLeastLeftOut = 6;                      // contours that can tell. 3 .9618; 12 the same
constexpr std::size_t kMostPoints = 450;                 // 225 .9626, .9692, .9817; 900 .9660, .9690, .9822
constexpr std::size_t kMostPointsToChoose = 225;         // 110 and 450 the same
constexpr double kStep = 1.0 / 15;  // of the radius, between nodes of a section's lattice. 1/30 .0002 more, 2/15 .0008 less
constexpr double kLeastArea = 0.002;                                      // of the square of the radius
constexpr double kSamePlaneCosine = 0.99939, kSamePlaneDistance = 0.005;  // as DrawnLines

Vec3 middle_of(const Contour& contour) {
    Vec3 sum;
    for (const Vec3& p : contour.points) sum += p;
    return sum / static_cast<double>(std::max<std::size_t>(1, contour.points.size()));
}

bool is_in_plane(const Contour& contour, const Plane& plane, double diameter_mm) {
    return std::abs(dot(contour.plane.normal, plane.normal)) > kSamePlaneCosine &&
           std::abs(plane.distance_to(middle_of(contour))) < kSamePlaneDistance * diameter_mm;
}

/// For each of the planes the contours that lie in it, those of the earliest moment first.
std::vector<std::vector<std::size_t>> contours_in(const std::vector<Plane>& planes, const ContourSet& set,
                                                  const Moments& moments) {
    const double diameter = diameter_mm(set);
    std::vector<std::vector<std::size_t>> in(planes.size());
    for (const std::vector<std::size_t>& at : moments.contours)
        for (const std::size_t n : at)
            for (std::size_t p = 0; p < planes.size(); ++p)
                if (is_in_plane(set.contours[n], planes[p], diameter)) in[p].push_back(n);
    return in;
}

TimeAsLength time_as_length(const Moments& moments, double speed_mm) {
    const std::vector<double>& times = moments.course.times();
    return {moments.course.cycle(), times.front(), std::max(times.back() - times.front(), 1e-300), speed_mm};
}

/// Points of all contours with their normals, from each moment's drawing.
std::vector<PointInTime> points_in_time(const DrawnMoments& drawn, FillRule fill_rule, const Work& work) {
    std::vector<PointInTime> points;
    for (std::size_t k = 0; k < drawn.sets.size(); ++k) {
        const Drawing drawing = read_drawing(drawn.sets[k], fill_rule);
        const PreparedContours prepared = prepare(drawing, resolved({.bounds = false}, drawing.diameter_mm()), work);
        for (const BoundaryPoint& point : prepared.points)
            if (point.contour != kNoContour && norm(point.inplane_normal) > 0)
                points.push_back({point.position, point.inplane_normal, drawn.moments.course.times()[k],
                                  drawn.moments.contours[k][drawing.numbers[static_cast<std::size_t>(point.contour)]]});
    }
    return points;
}

/// The one with which a process foretells best the contours of moments that are not whole, each left out in turn.
double chosen_speed_mm(const std::vector<PointInTime>& points, const DrawnMoments& drawn, SpaceTimeOptions options,
                       const Work& work) {
    std::vector<double> counts;
    for (std::size_t k = 0; k < drawn.sets.size(); ++k)
        for (const std::size_t n : drawn.moments.contours[k]) {
            counts.resize(std::max(counts.size(), n + 1));
            counts[n] = 1 - drawn.weights[k];
        }
    const double radius = options.ball.radius;
    if (std::accumulate(counts.begin(), counts.end(), 0.0) < kLeastLeftOut) return kSpeeds[kUsualSpeed] * radius;
    const std::vector<PointInTime> some = thinned(points, kMostPointsToChoose);
    std::array<double, kSpeeds.size()> errors{};
    parallel_for(kSpeeds.size(), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s) {
            SpaceTimeOptions of_this = options;
            of_this.time.speed_mm = kSpeeds[s] * radius;
            errors[s] = SpaceTimeFunction(some, of_this, {.threads = 1, .stop = work.stop}).left_out_error_mm(counts);
        }
    });
    return kSpeeds[static_cast<std::size_t>(std::min_element(errors.begin(), errors.end()) - errors.begin())] * radius;
}

/// Where the function vanishes in a plane, near what was drawn in it at other moments.
std::vector<Contour> section_of(const SpaceTimeFunction& function, const Plane& plane, double time, const Box3& region,
                                double radius_mm) {
    const double step = kStep * radius_mm;
    std::vector<Contour> contours;
    const std::optional<IsolineLattice> lattice = lattice_over(plane, corners(region.padded(2 * step)), step);
    if (!lattice) return contours;
    std::vector<Vec3> nodes;
    for (std::int64_t j = 0; j < lattice->rows; ++j)
        for (std::int64_t i = 0; i < lattice->columns; ++i) nodes.push_back(plane.from_uv(lattice->uv(i, j)));
    for (const Isoline& line : isolines(*lattice, function.values(nodes, time))) {
        if (line.area_mm2 < kLeastArea * radius_mm * radius_mm || line.points.size() < 3) continue;
        Contour& contour = contours.emplace_back(Contour{plane, {}, true, line.hole});
        for (const auto& uv : line.points) contour.points.push_back(plane.from_uv(uv));
    }
    return contours;
}

}  // namespace

DrawnMoments drawn_moments(const ContourSet& set, const Moments& moments) {
    DrawnMoments drawn{moments, {}, {}, {}};
    const std::vector<Plane> planes = DrawnLines(set).planes();
    const std::vector<std::vector<std::size_t>> in = contours_in(planes, set, moments);
    for (const std::vector<std::size_t>& at : moments.contours) {
        drawn.sets.push_back(at_moment(set, at));
        std::vector<Plane>& missing = drawn.missing.emplace_back();
        for (std::size_t p = 0; p < planes.size(); ++p) {
            const auto is_drawn = [&](std::size_t n) { return std::find(at.begin(), at.end(), n) != at.end(); };
            if (std::none_of(in[p].begin(), in[p].end(), is_drawn)) missing.push_back(planes[p]);
        }
        const auto count = static_cast<double>(planes.size());
        const double share = 1 - static_cast<double>(missing.size()) / count;
        drawn.weights.push_back(std::clamp((share - kLeastFraction) / (kWholeFraction - kLeastFraction), 0.0, 1.0));
    }
    return drawn;
}

std::vector<std::vector<Contour>> carried_sections(const ContourSet& set, const DrawnMoments& drawn,
                                                   const WholeMotion& whole, FillRule fill_rule, const Work& work) {
    const Moments& moments = drawn.moments;
    std::vector<std::vector<Contour>> carried(drawn.sets.size());
    if (std::all_of(drawn.weights.begin(), drawn.weights.end(), [](double weight) { return weight == 1; })) return carried;
    work.report("carry sections", 0);
    const Ball3 ball = smallest_ball(set);
    const std::vector<PointInTime> points = points_in_time(drawn, fill_rule, work);
    SpaceTimeOptions options{ball, time_as_length(moments, 0), &whole};
    options.time.speed_mm = chosen_speed_mm(points, drawn, options, work);
    const SpaceTimeFunction function(thinned(points, kMostPoints), options, work);
    const std::vector<Plane> planes = DrawnLines(set).planes();
    const std::vector<std::vector<std::size_t>> in = contours_in(planes, set, moments);
    parallel_for(static_cast<std::int64_t>(carried.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
            if (drawn.weights[k] == 1) continue;
            for (std::size_t p = 0; p < planes.size(); ++p) {
                if (std::find(drawn.missing[k].begin(), drawn.missing[k].end(), planes[p]) == drawn.missing[k].end())
                    continue;
                Box3 region;
                for (const std::size_t n : in[p])
                    for (const Vec3& point : set.contours[n].points) region.extend(point);
                // An outline may be larger at this moment than at others.
                const std::vector<Contour> section = section_of(function, planes[p], moments.course.times()[k],
                                                                region.padded(0.25 * ball.radius), ball.radius);
                carried[k].insert(carried[k].end(), section.begin(), section.end());
            }
        }
    });
    return carried;
}

}  // namespace kontur
