// SPDX-License-Identifier: Apache-2.0
#include "published.h"

#include <chrono>

#include "kontur/extract/voxelize.h"
#include "kontur/fit/fit.h"

namespace kontur::bench {
namespace {

/// The work's result; its wall time goes to the report.
template <typename Task>
auto timed(SegmentReport& report, const char* stage, const Task& task) {
    const auto start = std::chrono::steady_clock::now();
    auto result = task();
    report.seconds.emplace_back(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return result;
}

}  // namespace

PreparedContours published_contours(const PhantomCase& phantom, double quality) {
    PrepareOptions options;
    options.quality = quality;
    options.least_segments = 0;
    options.bounds = false;
    options.reconcile.conflicts = Conflicts::exact;
    return prepare(phantom.contours, options);
}

PlaceOptions published_placing() { return {.normal_offset_mm = 1, .merge_distance_mm = 0}; }

Segmentation segment_as_published(const PhantomCase& phantom, Solver solver, double quality) {
    FitOptions options;
    options.normals = Normals::in_plane;
    const PlaceOptions placing = published_placing();
    options.normal_offset_mm = placing.normal_offset_mm;
    options.merge_distance_mm = placing.merge_distance_mm;
    options.solve.kernel = Kernel::triharmonic;
    options.solve.solver = solver;

    Segmentation result;
    SegmentReport& report = result.report;
    const PreparedContours contours = timed(report, "prepare", [&] { return published_contours(phantom, quality); });
    const FittedFunction fitted = timed(report, "fit", [&] { return fit(contours, options); });
    result.function = fitted.function;
    result.mask = timed(report, "voxelize", [&] {
        return fill(track_surface(fitted.function, phantom.grid, drawn_points(phantom.contours), {.threads = 0}));
    });
    report.residual = timed(report, "measure", [&] { return residual(fitted.function, phantom.contours); });
    report.quality = quality;
    report.centres = fitted.report.centres;
    report.kernel = options.solve.kernel;
    report.normals = options.normals;
    report.solves = fitted.solves;
    return result;
}

std::vector<Vec3> drawn_points(const ContourSet& set) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

}  // namespace kontur::bench
