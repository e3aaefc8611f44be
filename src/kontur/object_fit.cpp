// SPDX-License-Identifier: Apache-2.0
#include "kontur/object_fit.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kontur/extract/find_surface.h"
#include "kontur/extract/voxelize.h"
#include "kontur/labels/outline_noise.h"
#include "kontur/memory_estimate.h"
#include "kontur/pipeline.h"
#include "kontur/segment.h"

namespace kontur {
namespace {

// Of the solver, in voxels: small labels take a quarter less time than with its own, and Dice changes by .0002.
constexpr double kTolerance = 0.01;
// By which f may leave a bound: what was painted stays anyway, and labels are solved half as often. In voxels: on the 34
// structures of docs/fill.md with one slice in eight Dice is .7354; half as much .7357, twice .7322. Of parallel slices also
// in the object's half thickness, for a fifth of the time: .7355; half as much .7350, twice .7320.
constexpr double kBoundsTolerance = 0.25, kBoundsShare = 0.2;
// Points that show the tilts of outlines: half as many Dice .7352, a thousand as these, for a sixth more time.
constexpr std::size_t kTiltPoints = 300;

SegmentOptions segment_options(const Grid& image, std::optional<double> smoothing, const ObjectFitOptions& options) {
    SegmentOptions segmenting;
    segmenting.use_image = options.use_image;
    segmenting.max_memory_mb = options.max_memory_mb;
    segmenting.smoothing = smoothing;
    segmenting.drawn_on = image;
    segmenting.tolerance_mm = kTolerance * smallest(image.spacing_mm());
    return segmenting;
}

double bounds_tolerance_of(const PaintedObject& object) {
    const double voxel_mm = smallest(object.grid.spacing_mm());
    const double share = object.only_axis() < 0 ? 0 : kBoundsShare;  // slices that cross tell more of each other
    return std::max(kBoundsTolerance * voxel_mm, share * half_thickness_mm(object));
}

/// As `segment`, without what it measures: nobody asks for it here.
ObjectFit fit_contours(const ContourSet& outlines, const FillGround& ground, double bounds_tolerance_mm,
                       const SegmentOptions& options, const Work& work) {
    const Drawing drawing = read_drawing(outlines, options.fill_rule);
    StageOptions stages = stage_options(options, drawing.diameter_mm());
    stages.prepare.image = options.drawn_on;
    stages.fit.tilt_points = kTiltPoints;
    stages.fit.bounds_tolerance_mm = bounds_tolerance_mm;
    const Grid voxels = grid_of(ground.image, ground.range);
    const PreparedContours prepared = prepare(drawing, stages.prepare, work);
    check_memory(estimated_memory_mb(drawing, prepared, voxels, options), options);
    FittedFunction fitted = fit(prepared, stages.fit, work);
    const std::vector<Vec3> starts =
        start_points(drawing.contours, prepared, fitted.function, *stages.prepare.click_margin_mm);
    const SurfaceLattice surface = find_surface(fitted.function, voxels, starts, options.voxelizer, work);
    return {fill(surface, work), std::move(fitted.function)};
}

}  // namespace

ObjectFit fit_outlines(const PaintedObject& object, const FillGround& ground, std::optional<double> smoothing,
                       const ObjectFitOptions& options, const Work& work) {
    return fit_contours(contours_of(object, options.smoothing_voxels), ground, bounds_tolerance_of(object),
                        segment_options(ground.image, smoothing, options), work);
}

ObjectFit fit_object(const PaintedObject& object, const FillGround& ground, const Image* image,
                     const ObjectFitOptions& options, const Work& work) {
    const ContourSet outlines = contours_of(object, options.smoothing_voxels);
    ImageReport report;
    if (image) {
        Segmentation with_image =
            segment(outlines, grid_of(ground.image, ground.range), image, segment_options(ground.image, {}, options), work);
        report = std::move(with_image.report.image);
        if (report.verdict == ImageVerdict::used)
            return {std::move(with_image.mask), std::move(with_image.function), std::move(report)};
    }
    const std::optional<double> smoothing = outline_smoothing(object, outlines);
    ObjectFit alone =
        fit_contours(outlines, ground, bounds_tolerance_of(object), segment_options(ground.image, smoothing, options), work);
    alone.image = std::move(report);
    return alone;
}

}  // namespace kontur
