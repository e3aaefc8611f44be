// SPDX-License-Identifier: Apache-2.0
#include "kontur/editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/extract/preview.h"
#include "kontur/stages.h"

namespace kontur {
namespace {

// A thousand points tell the surface to some 0.1 mm, so the solver need not do better.
constexpr double kPreviewTolerance = 50;    // times that of the refined surface
constexpr double kSpacingFraction = 0.015;  // of the contours' diameter
constexpr double kShownNoise = 0.05;        // of the preview's spacing: what the image said before
// A cut is cheap: it may be finer than the mesh.
constexpr double kCutFraction = 2.0 / 3;  // of the preview's spacing

bool same_drawing(const Contour& a, const Contour& b) {
    return a.points == b.points && a.plane.origin == b.plane.origin && a.plane.normal == b.plane.normal &&
           a.closed == b.closed;
}

EditedSurface surface_of(const FittedFunction& fit, std::span<const Vec3> starts, const PreviewOptions& lattice,
                         const Work& work) {
    EditedSurface surface;
    surface.function = fit.function;
    surface.solves = fit.solves;
    surface.spacing_mm = lattice.spacing_mm;
    surface.mesh = preview_surface(surface.function, starts, lattice, work);
    return surface;
}

}  // namespace

Editor::Editor(EditorOptions options) : options_(options) {
    check_not_below_0("the preview's spacing", options_.preview_spacing_mm, " mm");
    check_not_below_0("the refined surface's spacing", options_.refined_spacing_mm, " mm");
    if (options_.preview_points < 1)
        throw Error(ErrorKind::invalid_input, "the preview is fitted to 0 points; at least 1 is needed");
}

double Editor::preview_spacing(double diameter_mm) const {
    return options_.preview_spacing_mm > 0 ? options_.preview_spacing_mm : kSpacingFraction * diameter_mm;
}

/// One slope per prepared point; those of unknown contours are 1. Empty when no contour is known.
std::vector<double> Editor::known_slopes(const ContourSet& contours, const PreparedContours& prepared) const {
    const std::size_t count = contours.contours.size();
    std::vector<std::size_t> points(count, 0), used(count, 0);
    for (const BoundaryPoint& p : prepared.points)
        if (p.contour != kNoContour) ++points[static_cast<std::size_t>(p.contour)];
    std::vector<const Known*> matches(count, nullptr);
    for (std::size_t c = 0; c < count; ++c) {
        const auto known = std::find_if(known_.begin(), known_.end(),
                                        [&](const Known& k) { return same_drawing(k.contour, contours.contours[c]); });
        if (known != known_.end() && known->slopes.size() == points[c]) matches[c] = &*known;
    }
    std::vector<double> slopes(prepared.points.size(), 1.0);
    bool any = false;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
        if (prepared.points[i].contour == kNoContour) continue;
        const auto c = static_cast<std::size_t>(prepared.points[i].contour);
        if (!matches[c]) continue;
        slopes[i] = matches[c]->slopes[used[c]++];
        any = true;
    }
    return any ? slopes : std::vector<double>();
}

void Editor::remember(const ContourSet& contours, const PreparedContours& prepared, const std::vector<double>& slopes) {
    known_.clear();
    for (const Contour& contour : contours.contours) known_.push_back({contour, {}});
    for (std::size_t i = 0; i < prepared.points.size(); ++i)
        if (prepared.points[i].contour != kNoContour)
            known_[static_cast<std::size_t>(prepared.points[i].contour)].slopes.push_back(slopes[i]);
}

EditedSurface Editor::preview(const ContourSet& drawn, const Work& work,
                              const std::function<void(const SurfaceBand&)>& ahead) {
    if (drawn.contours.empty()) return {};
    std::vector<std::pair<std::string, double>> seconds;
    Stopwatch watch(seconds);
    const Drawing drawing = read_drawing(drawn, options_.segment.fill_rule);
    StageOptions stages = stage_options(options_.segment, drawing.diameter_mm());
    PreparedContours prepared = prepare(drawing, stages, work);
    const double spacing_mm = preview_spacing(drawing.diameter_mm());
    const std::vector<Vec3> shown = asked_.still_shown(drawing.contours);
    for (const Vec3& place : shown)
        prepared.bounds.push_back({.position = place, .least_mm = 0, .most_mm = 0, .noise_mm = kShownNoise * spacing_mm});
    watch.lap("prepare");
    stages.fit.most_points = options_.preview_points;
    stages.fit.tilt_points = options_.preview_points;
    stages.fit.solve.tolerance_mm *= kPreviewTolerance;
    stages.fit.early_tolerance_factor = 2;
    stages.fit.start_slopes = known_slopes(drawing.contours, prepared);
    if (!shown.empty()) stages.fit.most_solves = 1;  // f misses such a place by ever so little, which is no reason for more
    if (!stages.fit.start_slopes.empty()) {          // the last round is enough
        stages.fit.start_smoothing *= std::pow(stages.fit.smoothing_factor, stages.fit.rounds - 1);
        stages.fit.rounds = 1;
    }
    const FittedFunction fitted = fit(prepared, stages.fit, work);
    watch.lap("fit");
    const std::vector<Vec3> starts =
        start_points(drawing.contours, prepared, fitted.function, stages.prepare.click_margin_mm);
    const PreviewOptions lattice{spacing_mm};
    if (ahead) ahead(SurfaceBand(fitted.function, starts, {kCutFraction * lattice.spacing_mm}, work));
    EditedSurface surface = surface_of(fitted, starts, lattice, work);
    watch.lap("mesh");
    surface.seconds = std::move(seconds);
    surface.shown_before = shown.size();
    remember(drawing.contours, prepared, fitted.slopes);
    return surface;
}

EditedSurface Editor::refine(const ContourSet& drawn, const Work& work) const {
    return Editor(options_).refine(drawn, nullptr, work);
}

EditedSurface Editor::refine(const ContourSet& drawn, const Image* image, const Work& work,
                             const std::function<void(const EditedSurface&)>& alone) {
    if (drawn.contours.empty()) {
        EditedSurface nothing;
        nothing.refined = true;
        return nothing;
    }
    const Drawing drawing = read_drawing(drawn, options_.segment.fill_rule);
    const StageOptions stages = stage_options(options_.segment, drawing.diameter_mm());
    const PreparedContours prepared = prepare(drawing, stages, work);
    const double spacing_mm =
        options_.refined_spacing_mm > 0 ? options_.refined_spacing_mm : preview_spacing(drawing.diameter_mm()) / 3;
    const auto refined_surface = [&](const FittedFunction& fitted) {
        EditedSurface surface =
            surface_of(fitted, start_points(drawing.contours, prepared, fitted.function, stages.prepare.click_margin_mm),
                       {spacing_mm}, work);
        surface.refined = true;
        surface.residual = residual(surface.function, drawing.contours, work);
        return surface;
    };
    const FittedFunction by_contours = fit(prepared, stages.fit, work);
    EditedSurface surface = refined_surface(by_contours);
    if (!image || options_.segment.use_image == UseImage::off) {
        forget_image();
        return surface;
    }
    if (alone) alone(surface);
    fits_->begin_question();
    RefinedFunction with_image = kontur::refine(drawing, prepared, by_contours, *image, stages, work, fits_.get());
    if (with_image.report.verdict == ImageVerdict::used) surface = refined_surface(with_image.fitted);
    surface.image = std::move(with_image.report);
    asked_ = AskedBefore(drawing.contours, surface.image.asked);
    return surface;
}

}  // namespace kontur
