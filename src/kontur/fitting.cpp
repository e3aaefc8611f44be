// SPDX-License-Identifier: Apache-2.0
#include "kontur/fitting.h"

#include <fmt/format.h>

#include <cmath>

#include "kontur/base/error.h"

namespace kontur {
namespace {

// Fractions of the contours' diameter (diameter_mm). The offset is short enough to stay clear of the opposite wall of thin
// structures and long enough for a well-conditioned system; docs/decisions/0001-surface-normals.md has the measurements.
constexpr double kOffsetFraction = 4.5e-3;
constexpr double kMergeFraction = 6e-4;
constexpr double kToleranceFraction = 1.5e-5;  // 0.004 mm on a liver
constexpr double kSurfaceSmoothing = 1e-5;

FitOptions fit_options(const SegmentOptions& options, double diameter_mm) {
    FitOptions fit;
    fit.normals = options.normals;
    fit.place.normal_offset_mm = options.normal_offset_mm.value_or(kOffsetFraction * diameter_mm);
    fit.place.merge_distance_mm = kMergeFraction * diameter_mm;
    if (!(fit.place.normal_offset_mm > 0 && std::isfinite(fit.place.normal_offset_mm)))
        throw Error(ErrorKind::invalid_input, fmt::format("the normal offset is {} mm; it must be finite and greater than 0",
                                                          fit.place.normal_offset_mm));
    fit.solve.kernel = options.kernel;
    fit.solve.solver = options.solver;
    fit.solve.smoothing = options.smoothing.value_or(options.normals == Normals::surface ? kSurfaceSmoothing : 0.0);
    fit.solve.tolerance_mm = options.tolerance_mm.value_or(kToleranceFraction * diameter_mm);
    fit.solve.threads = options.threads;
    return fit;
}

/// The paper's in-plane normals go with its rules for long segments and coplanar contours; surface normals with ours.
PrepareOptions prepare_options(const SegmentOptions& options, const FitOptions& fitting) {
    PrepareOptions prepare{.quality = options.quality,
                           .fill_rule = options.fill_rule,
                           .click_margin_mm = fitting.place.normal_offset_mm,
                           .threads = options.threads};
    prepare.corners = options.corners;
    prepare.corner_spacing_mm = 2 * fitting.place.merge_distance_mm;
    if (options.normals == Normals::in_plane) {
        prepare.corners = Corners::rounded;
        prepare.least_segments = 0;
        prepare.caps = false;
        prepare.gaps = false;
        prepare.copy_shift_mm = fitting.place.normal_offset_mm;
    }
    return prepare;
}

}  // namespace

Fitting fitting_for(const ContourSet& contours, const SegmentOptions& options) {
    const double diameter = diameter_mm(contours);
    const FitOptions fit = fit_options(options, diameter);
    const ReconcileOptions reconcile{
        .conflicts = options.normals == Normals::in_plane ? Conflicts::exact : options.conflicts,
        .offset_mm = kOffsetFraction * diameter};
    return {prepare_options(options, fit), reconcile, fit};
}

PreparedContours prepare(const ContourSet& contours, const Fitting& fitting) {
    PreparedContours prepared = prepare(contours, fitting.prepare);
    reconcile(prepared.points, find_crossings(contours), fitting.reconcile);
    return prepared;
}

std::vector<Vec3> start_points(const ContourSet& contours, const PreparedContours& prepared) {
    std::vector<Vec3> starts = prepared.crossings;
    starts.insert(starts.end(), prepared.between_crossings.begin(), prepared.between_crossings.end());
    for (const BoundaryPoint& point : prepared.points) starts.push_back(point.position);
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    return starts;
}

}  // namespace kontur
