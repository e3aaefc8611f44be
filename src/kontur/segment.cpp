// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/entries.h"
#include "kontur/extract/mesh_grid.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/tracker.h"
#include "kontur/field/clicks.h"
#include "kontur/fitting.h"
#include "kontur/measure/components.h"
#include "kontur/memory_estimate.h"

namespace kontur {
namespace {

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

void note_filling(const FillChanges& changes, std::vector<std::string>& warnings) {
    if (changes.holes > 0) warnings.push_back(fmt::format("{} contours inside others became holes", changes.holes));
    if (changes.removed > 0)
        warnings.push_back(fmt::format("{} contours inside the object were left out: they are not holes", changes.removed));
    if (!changes.stray_holes.empty())
        warnings.push_back(
            fmt::format("{} contours are holes where nothing is drawn around them, the first of them "
                        "contour {}",
                        changes.stray_holes.size(), changes.stray_holes.front() + 1));
    for (const auto& [a, b] : changes.crossings)
        warnings.push_back(fmt::format("contours {} and {} overlap in part", a + 1, b + 1));
}

/// The contours without repeated points, checked, with their holes found and a word on what was changed.
ContourSet cleaned(ContourSet set, const Grid& grid, FillRule fill_rule, std::vector<std::string>& warnings) {
    if (const std::size_t dropped = drop_duplicate_points(set); dropped > 0)
        warnings.push_back(fmt::format("{} repeated points were left out", dropped));
    check_contours(set);
    check_grid(grid);
    if (const auto warning = check_contours_inside(set, grid)) warnings.push_back(*warning);
    note_filling(apply_fill_rule(set, fill_rule), warnings);
    return set;
}

SurfaceLattice find_surface(const ImplicitFunction& function, const Grid& grid, std::vector<Vec3> starts,
                            const SegmentOptions& options, const Progress& progress) {
    if (options.voxelizer == Voxelizer::exhaustive) return sample_everywhere(function, grid, options.threads, progress);
    const Entries from_outside = entries(function, grid, starts, options.threads, progress);
    starts.insert(starts.end(), from_outside.points.begin(), from_outside.points.end());
    SurfaceLattice surface = options.voxelizer == Voxelizer::tracked
                                 ? track_surface(function, grid, starts, options.threads, progress)
                                 : track_surface_adaptively(function, grid, starts, options.threads, progress);
    surface.evaluations += from_outside.evaluations;
    return surface;
}

/// The surface on the mask's lattice, or on a finer one where its voxels are coarse beside the object: chords between slices
/// that are far apart leave out a part of the object.
TriangleMesh mesh_of(const SurfaceLattice& surface, const ImplicitFunction& function, std::vector<Vec3> starts,
                     double spacing_mm, const SegmentOptions& options, const Progress& progress) {
    const Grid grid = mesh_grid(surface, starts, spacing_mm);
    if (grid == surface.lattice.grid()) return polygonize(surface, function, options.threads, progress);
    if (options.voxelizer == Voxelizer::exhaustive) {  // what no contour touches is in the mask, too
        const std::vector<Vec3> cuts = cut_points(surface);
        starts.insert(starts.end(), cuts.begin(), cuts.end());
    }
    SegmentOptions following = options;
    following.voxelizer = Voxelizer::adaptive;
    return polygonize(find_surface(function, grid, std::move(starts), following, progress), function, options.threads,
                      progress);
}

/// A sentence on the worst crossing, if it is worse than both a voxel and 1 % of the contours' box.
void describe_crossings(const ContourSet& contours, const Grid& grid, SegmentReport& report) {
    report.crossings = find_crossings(contours);
    std::stable_sort(report.crossings.begin(), report.crossings.end(),
                     [](const Crossing& a, const Crossing& b) { return a.disagreement_mm > b.disagreement_mm; });
    if (report.crossings.empty()) return;
    const Crossing& worst = report.crossings.front();
    const double limit_mm = std::max(std::cbrt(grid.voxel_volume_mm3()), 0.015 * diameter_mm(contours));
    if (worst.disagreement_mm > limit_mm) report.warnings.push_back("contours contradict each other: " + sentence(worst));
}

/// A value on the surface and one beside it for each point, and what ends the object; fewer where some nearly repeat others.
std::size_t expected_centres(const PreparedContours& prepared) {
    return 2 * prepared.points.size() + prepared.bounds.size();
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

void describe_fit(const PreparedContours& prepared, const Fit& fit, const FitOptions& options, SegmentReport& report) {
    report.constraints = fit.constraints;
    report.centres = fit.report.centres;
    report.kernel = options.solve.kernel;
    report.normals = options.normals;
    report.normal_offset_mm = options.place.normal_offset_mm;
    report.smoothing = options.solve.smoothing;
    report.tolerance_mm = options.solve.tolerance_mm;
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
    if (fit.report.solver == Solver::iterative && fit.report.residual > options.solve.tolerance_mm)
        report.warnings.push_back(fmt::format("the solver stopped at an error of {:.3g} mm; {:.3g} mm were asked for",
                                              fit.report.residual, options.solve.tolerance_mm));
    if (!prepared.crossings.empty())
        report.warnings.push_back(fmt::format(
            "contours cross themselves at {} points; lobes are filled by the even-odd rule", prepared.crossings.size()));
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

}  // namespace

Segmentation segment(const ContourSet& drawn, const Grid& grid, const SegmentOptions& options, const Progress& progress) {
    Segmentation result;
    SegmentReport& report = result.report;
    Stopwatch watch(report.seconds);

    const ContourSet contours = cleaned(drawn, grid, options.fill_rule, report.warnings);
    const Fitting fitting = fitting_for(contours, options);
    const PreparedContours prepared = prepare(contours, fitting);
    report.estimated_memory_mb = estimated_memory_mb(contours, expected_centres(prepared), grid, options);
    check_memory(report.estimated_memory_mb, options);
    watch.lap("prepare");
    const Fit fitted = fit(prepared, fitting.fit, progress);
    result.function = fitted.function;
    watch.lap("fit");
    const std::vector<Vec3> starts = start_points(contours, prepared, result.function, fitting.prepare.click_margin_mm);
    const SurfaceLattice surface = find_surface(result.function, grid, starts, options, progress);
    result.mask = fill(surface, options.threads);
    watch.lap("voxelize");
    if (options.mesh) {
        result.mesh =
            mesh_of(surface, result.function, starts, kMeshSpacingFraction * diameter_mm(contours), options, progress);
        watch.lap("polygonize");
    }

    report.contours = contours.contours.size();
    report.points = point_count(contours);
    report.quality = options.quality;
    report.voxelizer = options.voxelizer;
    report.fill_rule = options.fill_rule;
    report.conflicts = fitting.reconcile.conflicts;
    report.corners = fitting.prepare.corners;
    append(report.warnings, prepared.notes);
    append(report.warnings, missed_clicks(contours, result.function, 2 * fitting.prepare.click_margin_mm));
    describe_fit(prepared, fitted, fitting.fit, report);
    report.residual = residual(result.function, contours, options.threads);
    describe_crossings(contours, grid, report);
    describe_mask(surface, result.mask, report);
    describe_lost_clicks(contours, result.function, result.mask, report.warnings);
    watch.lap("measure");
    return result;
}

Provenance provenance(const ContourSet& contours, const Grid& grid, const SegmentReport& report) {
    return {
        {"contours_sha256", contours_sha256(contours)},
        {"grid_sha256", grid_sha256(grid)},
        {"version", KONTUR_VERSION},
        {"options", fmt::format("kernel={} normals={} conflicts={} fill_rule={} corners={} normal_offset_mm={} smoothing={} "
                                "quality={} solver={} tolerance_mm={} voxelizer={}",
                                name(report.kernel), name(report.normals), name(report.conflicts), name(report.fill_rule),
                                name(report.corners), report.normal_offset_mm, report.smoothing, report.quality,
                                name(report.solver), report.tolerance_mm, name(report.voxelizer))},
    };
}

}  // namespace kontur
