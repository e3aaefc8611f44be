// SPDX-License-Identifier: Apache-2.0
#include "kontur/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/drawing/ring_starts.h"
#include "kontur/fit/sides.h"
#include "kontur/fit/spread.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr std::size_t kCoarsePoints = 500;  // of contours from which others are left out
constexpr std::size_t kCoarseLines = 2;     // times as many points as the fit has tell where lines run

FitOptions fit_options(const SegmentOptions& options) {
    FitOptions fit;
    fit.normals = options.normals;
    fit.normal_offset_mm = options.normal_offset_mm;
    fit.solve.kernel = options.kernel;
    fit.solve.solver = options.solver;
    fit.solve.smoothing = options.smoothing;
    fit.solve.tolerance_mm = options.tolerance_mm;
    return fit;
}

/// The paper's in-plane normals go with its rules for long segments and coplanar contours; surface normals with ours.
PrepareOptions prepare_options(const SegmentOptions& options, double normal_offset_mm) {
    PrepareOptions prepare{.quality = options.quality, .reconcile = {.conflicts = options.conflicts}};
    prepare.corners = options.corners;
    if (options.normals == Normals::in_plane) {
        prepare.reconcile.conflicts = Conflicts::exact;
        prepare.corners = Corners::rounded;
        prepare.least_segments = 0;
        prepare.bounds = false;
        prepare.gaps = false;
        prepare.copy_shift_mm = normal_offset_mm;
    }
    return prepare;
}

/// Where the surface passes near a point at which |f| is about `margin_mm`; nothing where |f| is larger or it is farther
/// away.
std::optional<Vec3> surface_near(const Vec3& point, const ImplicitFunction& function, double margin_mm) {
    constexpr int kSteps = 24, kHalvings = 12;
    const double value = function.value(point);
    if (std::abs(value) > 2 * margin_mm) return std::nullopt;
    const auto has_other_sign = [&](const Vec3& p) { return (function.value(p) > 0) != (value > 0); };
    for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        for (const double step : {margin_mm, -margin_mm})
            for (int n = 1; n <= kSteps; ++n) {
                if (!has_other_sign(point + n * step * direction)) continue;
                double near = (n - 1) * step, far = n * step;
                for (int halving = 0; halving < kHalvings; ++halving) {
                    const double middle = (near + far) / 2;
                    (has_other_sign(point + middle * direction) ? far : near) = middle;
                }
                return point + far * direction;
            }
    return std::nullopt;
}

}  // namespace

StageOptions stage_options(const SegmentOptions& options, double diameter_mm) {
    const FitOptions fit = resolved(fit_options(options), diameter_mm);
    return {resolved(prepare_options(options, *fit.normal_offset_mm), diameter_mm), fit};
}

ContourSet thinned(ContourSet set, std::size_t most) {
    const std::size_t count = point_count(set);
    const Ball3 ball = smallest_ball(set);
    for (Contour& contour : set.contours) {
        const std::size_t step = std::min(count / most, contour.points.size() / kLeastSegments);
        if (step < 2) continue;
        begin_alike(contour, ball);  // a circle is so regular that nothing else tells its points apart
        const auto apart_mm = static_cast<double>(step) * line_length(contour.points, contour.closed) /
                              static_cast<double>(contour.points.size()) / kSpreadApart;
        const std::vector<bool> is_chosen =
            spread_along({contour.points, contour.closed}, std::vector(contour.points.size(), apart_mm), 0);
        std::vector<Vec3> chosen_points;
        for (std::size_t i = 0; i < contour.points.size(); ++i) {
            const bool is_end = !contour.closed && (i == 0 || i + 1 == contour.points.size());
            if (is_chosen[i] || is_end) chosen_points.push_back(contour.points[i]);
        }
        contour.points = std::move(chosen_points);
    }
    return set;
}

ImplicitFunction fit_coarsely(const ContourSet& part, const StageOptions& options, const Work& work) {
    const Drawing drawing = read_drawing(thinned(part, kCoarseLines * kCoarsePoints), FillRule::declared);
    StageOptions coarse = options;
    coarse.fit.most_points = coarse.fit.tilt_points = kCoarsePoints;
    coarse.fit.rounds = std::min(options.fit.rounds, 1);
    coarse.fit.most_solves = 1;
    *coarse.fit.solve.tolerance_mm *= coarse.fit.early_tolerance_factor;
    return fit(prepare(drawing, coarse.prepare, work), coarse.fit, work).function;
}

ImageFit follow_image(const FittedDrawing& fit, const Image& image, const StageOptions& options, const Work& work,
                      PartFits* part_fits) {
    work.report("ask the image", 0);
    const Work alone{.threads = 1, .stop = work.stop};  // parts are fitted beside each other
    const FitContours fit_part = [&](const ContourSet& part) { return fit_coarsely(part, options, alone); };
    const FitContours fit_once = [&](const ContourSet& part) {
        return part_fits->of(part, fit.drawing.diameter_mm(), fit_part);
    };
    return follow_image(fit, image, part_fits ? fit_once : fit_part, {.fit = options.fit}, work);
}

namespace {

/// Where contours contradict each other the surface may miss one of them, or all: places of it towards which f leads from
/// contours that are `margin_mm` off it wherever they were looked at.
std::vector<Vec3> surface_of_missed(const ContourSet& contours, const ImplicitFunction& function, double margin_mm) {
    constexpr std::size_t kLookedAt = 8;  // points of each contour
    constexpr int kSteps = 20;
    std::vector<Vec3> looked_at;
    std::vector<std::size_t> ends;  // of each contour's
    for (const Contour& contour : contours.contours) {
        ContourSet alone;
        alone.contours = {contour};
        const std::vector<Vec3> points = along_contours(alone, length_mm(contour) / kLookedAt);
        looked_at.insert(looked_at.end(), points.begin(), points.end());
        ends.push_back(looked_at.size());
    }
    std::vector<double> values(looked_at.size());
    function.values(looked_at, values);  // at once: one by one they take as long as thirty
    std::vector<Vec3> slid;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        const auto misses = [&](double value) { return std::abs(value) > margin_mm; };
        if (std::all_of(values.begin() + begin, values.begin() + end, misses))
            slid.insert(slid.end(), looked_at.begin() + begin, looked_at.begin() + end);
        begin = end;
    }
    slide_to_surface(function, slid, {.reach_mm = bounding_box(contours).diagonal() / kSteps, .steps = kSteps}, {});
    std::erase_if(slid, [&](const Vec3& p) { return std::abs(function.value(p)) > margin_mm; });
    return slid;
}

}  // namespace

std::vector<Vec3> start_points(const ContourSet& contours, const PreparedContours& prepared,
                               const ImplicitFunction& function, double margin_mm) {
    std::vector<Vec3> starts = prepared.crossings;
    starts.insert(starts.end(), prepared.between_crossings.begin(), prepared.between_crossings.end());
    for (const BoundaryPoint& point : prepared.points) starts.push_back(point.position);
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    if (margin_mm > 0) {
        const std::vector<Vec3> missed_surface = surface_of_missed(contours, function, margin_mm);
        starts.insert(starts.end(), missed_surface.begin(), missed_surface.end());
    }
    for (const Vec3& click : contours.exterior)
        if (const auto start = surface_near(click, function, margin_mm)) starts.push_back(*start);
    return starts;
}

}  // namespace kontur
