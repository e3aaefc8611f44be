// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/follow_image.h"

#include <cmath>

#include "kontur/drawing/stored_alike.h"
#include "kontur/image/displace.h"
#include "kontur/image/leave_out.h"
#include "kontur/image/move_surface.h"
#include "kontur/image/refit.h"
#include "kontur/image/walk_surface.h"
#include "kontur/sampling/plane_groups.h"

namespace kontur {
namespace {

/// What speaks for the image and against it.
struct Trial {
    std::optional<LeftOutPlanes> left_out;
    std::optional<HeldOutErrors>
        displacement;  ///< measured where leaving planes out does not show, or hardly, that it helps
    double left_out_weight = 0, displacement_weight = 0;  ///< how far the surface moves by each; together at most 1
    double not_denied = 1;                                ///< how far displacing lets the other count

    double moving() const { return left_out_weight + displacement_weight; }
    double walking() const { return left_out ? not_denied * left_out->walking(moving()) : 0; }
    /// By which it was mostly decided whether the surface moves.
    const HeldOutErrors* deciding() const {
        const bool is_displaced = displacement && (!left_out || displacement_weight > left_out_weight);
        return is_displaced ? &*displacement : left_out ? &left_out->errors : nullptr;
    }

    /// By which it does.
    Beliefs beliefs() const {
        if (displacement_weight == 0) return left_out->errors.beliefs(left_out_weight);
        const Beliefs by_displacing = displacement->beliefs(displacement_weight);
        if (left_out_weight == 0) return by_displacing;
        const Beliefs by_leaving_out = left_out->errors.beliefs(left_out_weight);
        const double share = displacement_weight / moving();
        return {[=](double mm) { return std::lerp(by_leaving_out.prior_mm(mm), by_displacing.prior_mm(mm), share); },
                [=](double mm) { return 1 / std::hypot(1 / by_leaving_out.image_mm(mm), 1 / by_displacing.image_mm(mm)); }};
    }
};

/// What becomes of a drawing, its fit and an image.
struct Question {
    const FittedDrawing& fit;
    const Image& image;
    const Surroundings& surroundings;
    const ImageOptions& options;
    const Work& work;

    SurfaceMovement movement(const Beliefs& beliefs) const {
        return surface_movement(fit, surroundings, beliefs, options.samples, work);
    }
    ImageFit fit_of(SurfaceMovement movement) const {
        return move_surface(std::move(movement), fit, surroundings, options.fit, work);
    }
    std::optional<ImageFit> fit_of_walk(const LeftOutPlanes& left_out, const std::optional<SurfaceMovement>& start) const {
        const Beliefs beliefs = left_out.errors.beliefs();
        return walk_surface({left_out.cells, surroundings.walls, beliefs, surroundings.image.voxel_mm()}, fit,
                            start ? &*start : nullptr, options, work);
    }
    /// From one function to that of a walk, as far as it is followed.
    ImageFit between_fits(const ImageFit& first, ImageFit walk, double share) const {
        if (share == 1) return walk;
        walk.fitted = between(first.fitted, walk.fitted, share);
        const double largest_mm = std::lerp(first.report.largest_move_mm, walk.report.largest_move_mm, share);
        const bool is_moved_rather = share < 0.5 && first.report.verdict == ImageVerdict::used;
        if (is_moved_rather) walk.report = first.report;  // the report is of what counts more
        walk.report.on_contours_mm = largest_change(fit.fitted.function, walk.fitted.function, fit.drawing.contours, work);
        walk.report.largest_move_mm = largest_mm;
        return walk;
    }
    ImageFit unchanged(ImageVerdict verdict) const { return {fit.fitted, {.verdict = verdict}}; }
};

Trial try_image(const Question& question, const FitContours& fit_contours) {
    Trial trial;
    const Drawing& drawing = question.fit.drawing;
    trial.left_out = leave_planes_out(drawing, question.image, fit_contours, question.work);
    if (trial.left_out) trial.left_out_weight = trial.left_out->moving();
    const bool are_few = contours_by_plane(drawing.contours).size() <= kFewestPlanes;  // leaving one out tells little
    if (trial.left_out_weight == 1 && !are_few) return trial;
    trial.displacement = displace_planes(drawing, question.image, question.fit.fitted.function, question.work);
    if (!trial.displacement) return trial;
    if (are_few) trial.not_denied = kNotDenied.at(trial.displacement->error_reduction());
    trial.left_out_weight *= trial.not_denied;
    trial.displacement_weight = (1 - trial.left_out_weight) * trial.displacement->weight(kTakenBack);
    return trial;
}

/// Moved as far as that helps, and from there to where a walk leads, as far as that helps more.
ImageFit follow(const Question& question, const Trial& trial, double walking) {
    std::optional<SurfaceMovement> movement;
    if (trial.moving() > 0) movement = question.movement(trial.beliefs());
    const std::int64_t intensities = movement ? movement->movement.intensities : 0;
    std::optional<ImageFit> walk;
    if (walking > 0) walk = question.fit_of_walk(*trial.left_out, movement);
    const bool is_astray = walking > 0 && !walk;
    ImageFit result = question.unchanged(is_astray          ? ImageVerdict::astray
                                         : trial.deciding() ? ImageVerdict::no_help
                                                            : ImageVerdict::unknown);
    if (movement && !(walk && walking == 1)) result = question.fit_of(*std::move(movement));
    if (walk) result = question.between_fits(result, *std::move(walk), walking);
    result.report.intensities = intensities;
    return result;
}

/// With what it was decided by.
void describe(const Trial& trial, double walking, ImageReport& report) {
    const HeldOutErrors* deciding = trial.deciding();
    if (!deciding) return;
    report.displaced = deciding != (trial.left_out ? &trial.left_out->errors : nullptr);
    report.intensities += deciding->intensities();
    report.planes_left_out = deciding->planes();
    report.error_without_mm = deciding->without_mm();
    report.error_with_mm = deciding->with_mm();
    if (report.verdict == ImageVerdict::used) report.weight = report.walked ? walking : trial.moving();
    if (!trial.left_out) return;
    report.intensities += trial.left_out->cells.intensities;
    if (walking == 0) return;
    const WrongCells wrong = sum(trial.left_out->wrong);
    report.wrong_without = wrong.by_contours / wrong.inside;
    report.wrong_with = wrong.by_walk / wrong.inside;
    if (report.walked)
        for (ImageShare& point : report.shares) point.share = report.share_left();
}

}  // namespace

ImageFit follow_image(const FittedDrawing& fit, const Image& image, const FitContours& fit_contours,
                      const ImageOptions& options, const Work& work) {
    check_image(image);
    if (is_label_map(image)) return {fit.fitted, {.verdict = ImageVerdict::labels}};
    Drawing alike = fit.drawing;
    alike.contours = stored_alike(fit.drawing.contours);
    const Surroundings surroundings(alike, image);
    const FittedDrawing fit_alike{alike, fit.prepared, fit.fitted};
    const Question question{fit_alike, image, surroundings, options, work};
    const Trial trial = try_image(question, fit_contours);
    const double walking = trial.walking();
    ImageFit result = follow(question, trial, walking);
    describe(trial, walking, result.report);
    return result;
}

}  // namespace kontur
