// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment.h"

#include <utility>

#include "kontur/base/stopwatch.h"
#include "kontur/describe.h"
#include "kontur/drawing_check.h"
#include "kontur/extract/find_surface.h"
#include "kontur/extract/mesh_grid.h"
#include "kontur/memory_estimate.h"
#include "kontur/pipeline.h"
#include "kontur/sampling/sample_surface.h"

namespace kontur {

Segmentation segment(const ContourSet& drawn, const Grid& grid, const SegmentOptions& options, const Work& work) {
    return segment(drawn, grid, nullptr, options, work);
}

Segmentation segment(const ContourSet& drawn, const Grid& grid, const Image* image, const SegmentOptions& options,
                     const Work& work) {
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch watch(seconds);
    Drawing drawing = read_drawing(drawn, options.fill_rule);
    check_grid(grid);
    if (const auto warning = check_contours_inside(drawing.contours, grid)) drawing.notes.push_back(*warning);
    StageOptions stages = stage_options(options, drawing.diameter_mm());
    stages.prepare.image = image ? image->grid : options.drawn_on;
    const PreparedContours prepared = prepare(drawing, stages.prepare, work);
    const double memory_mb = estimated_memory_mb(drawing, prepared, grid, options);
    check_memory(memory_mb, options);
    watch.lap("prepare");

    const FittedFunction by_contours = fit(prepared, stages.fit, work);
    watch.lap("fit");
    const bool asks_image = image && options.use_image != UseImage::off;
    const auto [fitted, image_report] =
        asks_image ? follow_image({drawing, prepared, by_contours}, *image, stages, work) : ImageFit{by_contours, {}};
    if (image_report.verdict != ImageVerdict::none) watch.lap("image");

    const std::vector<Vec3> starts =
        start_points(drawing.contours, prepared, fitted.function, *stages.prepare.click_margin_mm);
    const SurfaceLattice surface = find_surface(fitted.function, grid, starts, options.voxelizer, work);
    Segmentation result{fill(surface, work), fitted.function, {}, {}, {}};
    watch.lap("voxelize");

    if (options.mesh) {
        const double spacing_mm = kMeshSpacingFraction * drawing.diameter_mm();
        result.mesh = surface_mesh(surface, fitted.function, starts, {spacing_mm, options.voxelizer}, work);
        watch.lap("polygonize");
    }

    SectionCheck check = check_sections(drawing, fitted.function, surface, result.mask, work);
    watch.lap("check");
    result.report = describe({drawing, stages, prepared, fitted, image_report, surface, result.mask, check}, options, work);
    result.samples = sample_surface(surface, fitted.function, kSurfaceSamples, work);
    result.report.uncertainty =
        surface_uncertainty(gather_evidence(result.samples, drawing.contours, evidence_facts(result.report, grid), work));
    if (std::optional<std::string> word = doubt(result.report.uncertainty))
        result.report.warnings.push_back(std::move(*word));
    watch.lap("measure");
    result.report.estimated_memory_mb = memory_mb;
    result.report.seconds = std::move(seconds);
    return result;
}

}  // namespace kontur
