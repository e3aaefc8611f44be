// SPDX-License-Identifier: Apache-2.0
#include "kontur/describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kontur/base/counted.h"
#include "kontur/fit/missed_clicks.h"
#include "kontur/fit/residual.h"
#include "kontur/measure/components.h"
#include "kontur/shape/enclosed_area.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// A sentence on the worst crossing, if it is worse than both a voxel and 1.5 % of the drawing's diameter.
void describe_crossings(const Drawing& drawing, const Grid& grid, SegmentReport& report) {
    report.crossings = drawing.crossings;
    std::stable_sort(report.crossings.begin(), report.crossings.end(),
                     [](const Crossing& a, const Crossing& b) { return a.disagreement_mm > b.disagreement_mm; });
    if (report.crossings.empty()) return;
    const Crossing& worst = report.crossings.front();
    const double limit_mm = std::max(std::cbrt(grid.voxel_volume_mm3()), 0.015 * drawing.diameter_mm());
    if (worst.disagreement_mm > limit_mm) report.warnings.push_back("contours contradict each other: " + sentence(worst));
}

/// Whether one of the voxels around a point is in the mask.
bool touches(const Mask& mask, const Affine3& to_index, const Vec3& p) {
    const Vec3 at = to_index.apply(p);
    const Index3& n = mask.grid.size;
    for (int corner = 0; corner < 8; ++corner) {
        const std::int64_t i = static_cast<std::int64_t>(std::floor(at.x)) + (corner & 1),
                           j = static_cast<std::int64_t>(std::floor(at.y)) + (corner >> 1 & 1),
                           k = static_cast<std::int64_t>(std::floor(at.z)) + (corner >> 2);
        if (i >= 0 && i < n.i && j >= 0 && j < n.j && k >= 0 && k < n.k && mask.values[mask.grid.offset(i, j, k)])
            return true;
    }
    return false;
}

/// Interior points that f has inside and the mask does not: what they made lies apart from the contours, where no surface is
/// looked for.
void describe_lost_clicks(const ContourSet& contours, const ImplicitFunction& function, const Mask& mask,
                          std::vector<std::string>& warnings) {
    const Affine3 to_index = mask.grid.index_to_mm.inverse();
    for (std::size_t c = 0; c < contours.interior.size(); ++c) {
        const Vec3& click = contours.interior[c];
        if (!mask.grid.bounds_mm().contains(click) || !(function.value(click) > 0) || touches(mask, to_index, click))
            continue;
        warnings.push_back(fmt::format(
            "interior point {} is not in the mask: it lies apart from the object, and no contour says what is there",
            c + 1));
    }
}

bool reaches_border(const Mask& mask) {
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j) {
            const bool border_row = k == 0 || k == n.k - 1 || j == 0 || j == n.j - 1;
            for (std::int64_t i = 0; i < n.i; i += border_row || n.i == 1 ? 1 : n.i - 1)
                if (mask.values[mask.grid.offset(i, j, k)]) return true;
        }
    return false;
}

void describe_fit(const PreparedContours& prepared, const FittedFunction& fit, const FitOptions& options,
                  SegmentReport& report) {
    report.constraints = fit.constraints;
    report.centres = fit.report.centres;
    report.kernel = options.solve.kernel;
    report.normals = options.normals;
    report.normal_offset_mm = *options.normal_offset_mm;
    report.smoothing = *options.solve.smoothing;
    report.tolerance_mm = *options.solve.tolerance_mm;
    report.solver = fit.report.solver;
    report.solves = fit.solves;
    report.iterations = fit.iterations;
    report.merged = fit.merged;
    report.bounded = fit.bounded;
    if (prepared.coplanar)
        report.warnings.push_back(
            options.normals == Normals::surface
                ? "all contours lie in one plane; the thickness of the object is a guess from their width"
                : "all contours lie in one plane; a copy of the first one was added close to it");
    if (fit.report.solver == Solver::iterative && fit.report.residual > report.tolerance_mm)
        report.warnings.push_back(fmt::format("the solver stopped at an error of {:.3g} mm; {:.3g} mm were asked for",
                                              fit.report.residual, report.tolerance_mm));
    if (!prepared.crossings.empty())
        report.warnings.push_back(fmt::format("contours cross themselves at {}; lobes are filled by the even-odd rule",
                                              counted(prepared.crossings.size(), "point")));
}

void describe_mask(const SurfaceLattice& surface, const Mask& mask, SegmentReport& report) {
    report.evaluations = surface.evaluations;
    report.surface_voxels = static_cast<std::int64_t>(surface.cells.size());
    const std::vector<std::int64_t> components = component_sizes(mask);
    report.mask_voxels = std::accumulate(components.begin(), components.end(), std::int64_t{0});
    report.mask_components = static_cast<std::int64_t>(components.size());
    report.mask_volume_ml = static_cast<double>(report.mask_voxels) * mask.grid.voxel_volume_mm3() / 1000;
    if (report.mask_voxels == 0) report.warnings.push_back("the mask is empty: no voxel centre lies inside of the surface");
    if (reaches_border(mask)) report.warnings.push_back("the object reaches the border of the image and is cut off there");
}

/// Half of the contours and more enclose less than a voxel, so that most of the object lies between the mask's places.
void describe_thinness(const ContourSet& contours, const Grid& grid, std::vector<std::string>& warnings) {
    const double face_mm2 = std::pow(grid.voxel_volume_mm3(), 2.0 / 3);
    std::size_t closed = 0, thin = 0;
    for (const Contour& contour : contours.contours) {
        if (!contour.closed) continue;
        ++closed;
        if (enclosed_area(section_of(contour, contour.plane).outlines.front()) < face_mm2) ++thin;
    }
    if (thin > 0 && 2 * thin >= closed)
        warnings.push_back(fmt::format("{} of {} enclose{} less than a voxel: smaller voxels would show the object whole",
                                       thin, counted(closed, "contour"), thin == 1 ? "s" : ""));
}

/// Where a contour has few points, the surface may leave the line between them.
void describe_long_edges(const StageResults& results, double contradiction_mm, const Work& work,
                         std::vector<std::string>& warnings) {
    constexpr double kShare = 0.02;  // of the drawing's diameter
    const auto& [drawing, stages, prepared, fitted, image, surface, mask, check] = results;
    const double diameter = drawing.diameter_mm();
    const Residual between =
        residual_between_points(fitted.function, drawing.contours, kShare * diameter, work, stages.prepare.image);
    if (between.max_mm <= kShare * diameter) return;
    // Contours that contradict each other yield, however many points they have.
    const bool yields = 2 * contradiction_mm > between.max_mm;
    const std::string why = yields
                                ? fmt::format(", where contours contradict each other by up to {:.2g} mm", contradiction_mm)
                                : "; with more points it follows the line";
    warnings.push_back(fmt::format("the surface leaves contour {} by {:.2g} mm between its points{}",
                                   between.worst_contour + 1, between.max_mm, why));
}

/// Nobody is 3 m tall: a contour that alone makes a drawing so wide mostly lies where it was not meant to.
void describe_strays(const Drawing& drawing, std::vector<std::string>& warnings) {
    constexpr double kMost_mm = 3000;
    if (drawing.diameter_mm() <= kMost_mm) return;
    std::vector<Ball3> contours;
    for (const Contour& contour : drawing.contours.contours) contours.push_back(smallest_ball(contour.points));
    double loneliest_mm = 0;
    std::size_t stray = 0;
    for (std::size_t c = 0; c < contours.size(); ++c) {
        double nearest_mm = std::numeric_limits<double>::infinity();
        for (std::size_t other = 0; other < contours.size(); ++other)
            if (other != c)
                nearest_mm = std::min(nearest_mm, distance(contours[c].center, contours[other].center) - contours[c].radius -
                                                      contours[other].radius);
        if (std::isfinite(nearest_mm) && nearest_mm > loneliest_mm) loneliest_mm = nearest_mm, stray = c;
    }
    if (loneliest_mm < drawing.diameter_mm() / 2) return;
    warnings.push_back(
        fmt::format("what was drawn is {:.0f} mm wide, and contour {} is {:.0f} mm from any other; see that no "
                    "contour lies where it does not belong",
                    drawing.diameter_mm(), stray + 1, loneliest_mm));
}

/// A single point that is farther from all lines than these are wide makes the object as long as its own distance.
void describe_far_points(const Drawing& drawing, std::vector<std::string>& warnings) {
    constexpr double kFar =
        1;  // diameters of the lines: half names the poles of a long object by a section, twice misses some
    ContourSet lines;
    lines.contours = drawing.contours.contours;
    const double diameter_mm = smallest_ball(lines).diameter();
    for (std::size_t i = 0; i < drawing.contours.surface.size(); ++i) {
        double nearest_mm = std::numeric_limits<double>::infinity();
        for (const Contour& contour : lines.contours)
            for (const Vec3& p : contour.points)
                nearest_mm = std::min(nearest_mm, distance(p, drawing.contours.surface[i].position));
        if (!(nearest_mm > kFar * diameter_mm) || lines.contours.empty()) continue;
        warnings.push_back(
            fmt::format("surface point {} is {:.3g} mm from every line, and these are {:.3g} mm across; the object "
                        "is drawn out to it; see that it lies where it belongs",
                        i + 1, nearest_mm, diameter_mm));
        return;
    }
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

SegmentReport describe(const StageResults& results, const SegmentOptions& options, const Work& work) {
    const auto& [drawing, stages, prepared, fitted, image, surface, mask, check] = results;
    const ContourSet& contours = drawing.contours;
    SegmentReport report;
    report.contours = contours.contours.size();
    report.points = drawing.points_drawn;
    report.quality = options.quality;
    report.voxelizer = options.voxelizer;
    report.use_image = options.use_image;
    report.image = image;
    report.near_lines = drawing.near_lines;
    report.fill_rule = options.fill_rule;
    report.conflicts = stages.prepare.reconcile.conflicts;
    report.corners = stages.prepare.corners;
    append(report.warnings, drawing.notes);
    append(report.warnings, prepared.notes);
    append(report.warnings, missed_clicks(contours, fitted.function, 2 * *stages.prepare.click_margin_mm));
    describe_fit(prepared, fitted, stages.fit, report);
    report.residual = residual(fitted.function, contours, work, stages.prepare.image);
    describe_crossings(drawing, mask.grid, report);
    describe_long_edges(results, disagreement(report.crossings).max_mm, work, report.warnings);
    describe_strays(drawing, report.warnings);
    describe_far_points(drawing, report.warnings);
    report.section_check = check;
    append(report.warnings, sentences(check));
    describe_thinness(contours, mask.grid, report.warnings);
    describe_mask(surface, mask, report);
    describe_lost_clicks(contours, fitted.function, mask, report.warnings);
    return report;
}

EvidenceFacts evidence_facts(const SegmentReport& report, const Grid& grid) {
    return {.volume_mm3 = 1000 * report.mask_volume_ml,
            .voxel_mm = smallest(grid.spacing_mm()),
            .residual_mm = report.residual.rms_mm,
            .disagreement_mm = trusted_disagreement_mm(disagreement(report.crossings)),
            .shares = report.image.shares};
}

Provenance provenance(const ContourSet& contours, const Grid& grid, const SegmentReport& report) {
    return {
        {"contours_sha256", contours_sha256(contours)},
        {"grid_sha256", grid_sha256(grid)},
        {"version", KONTUR_VERSION},
        {"options",
         fmt::format("kernel={} normals={} conflicts={} fill_rule={} corners={} normal_offset_mm={} smoothing={} "
                     "quality={} solver={} tolerance_mm={} voxelizer={} image={}",
                     name(report.kernel), name(report.normals), name(report.conflicts), name(report.fill_rule),
                     name(report.corners), report.normal_offset_mm, report.smoothing, report.quality, name(report.solver),
                     report.tolerance_mm, name(report.voxelizer), name(report.image.verdict))},
    };
}

}  // namespace kontur
