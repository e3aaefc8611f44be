// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/refine.h"

#include "kontur/refine/displace.h"
#include "kontur/refine/leave_out.h"
#include "kontur/refine/move_surface.h"
#include "kontur/refine/walk_surface.h"

namespace kontur {
namespace {

constexpr double kCautiousSlope = 0.12;  // without the gate: prior standard deviation over the distance ...
constexpr double kCautiousImage = 0.7;   // ... and the image's error in voxels

/// What speaks for the image and against it.
struct Trial {
    std::optional<LeftOutPlanes> left_out;
    std::optional<HeldOutErrors> displaced;  ///< asked where leaving planes out does not show that the image helps

    bool left_out_helps() const { return left_out && left_out->errors.image_helps(); }
    bool displacing_helps() const { return displaced && displaced->image_helps(1 - kTakenBack); }
    /// By which the surface is moved; none if it is not.
    const HeldOutErrors* helping() const {
        return left_out_helps() ? &left_out->errors : displacing_helps() ? &*displaced : nullptr;
    }
    /// By which it was decided whether it is.
    const HeldOutErrors* deciding() const {
        if (const HeldOutErrors* errors = helping()) return errors;
        return left_out ? &left_out->errors : displaced ? &*displaced : nullptr;
    }
    bool walk_helps() const { return left_out && kontur::walk_helps(left_out->wrong, helping() != nullptr); }
};

/// What becomes of a drawing, its fit and an image.
struct Question {
    const Drawing& drawing;
    const PreparedContours& prepared;
    const FittedFunction& fitted;
    const Image& image;
    const DrawnOnImage& drawn;
    const RefineOptions& options;
    const Work& work;

    AskedSurface asked(const Beliefs& beliefs) const { return ask_surface(drawn, drawing, fitted, beliefs, options, work); }
    RefinedFunction moved(AskedSurface surface, const Beliefs& beliefs) const {
        return move_surface(std::move(surface), drawn, drawing, prepared, fitted, beliefs, options, work);
    }
    std::optional<RefinedFunction> walked(const LeftOutPlanes& left_out, const std::optional<AskedSurface>& begin) const {
        const Beliefs beliefs = left_out.errors.beliefs();
        return walk_surface({left_out.cells, drawn.walls, beliefs}, drawing, prepared, fitted,
                            begin ? &begin->movement : nullptr, options, drawn.image.voxel_mm(), work);
    }
    RefinedFunction unchanged(ImageVerdict verdict) const { return {fitted, {.verdict = verdict}}; }
};

Trial try_image(const Question& asked, const FitContours& fit_contours) {
    Trial trial{leave_planes_out(asked.drawing, asked.image, fit_contours, asked.work), {}};
    if (!trial.left_out_helps())
        trial.displaced = displace_planes(asked.drawing, asked.image, asked.fitted.function, asked.work);
    return trial;
}

/// By a walk, if that helps most, or else moved, if that helps.
RefinedFunction follow(const Question& asked, const Trial& trial) {
    const HeldOutErrors* helping = trial.helping();
    std::optional<AskedSurface> surface;
    if (helping) surface = asked.asked(helping->beliefs());
    const std::int64_t intensities = surface ? surface->movement.intensities : 0;
    if (trial.walk_helps()) {
        if (std::optional<RefinedFunction> walked = asked.walked(*trial.left_out, surface)) {
            walked->report.intensities = intensities;
            return *std::move(walked);
        }
        if (!helping) return asked.unchanged(ImageVerdict::astray);
    }
    if (helping) return asked.moved(*std::move(surface), helping->beliefs());
    return asked.unchanged(trial.deciding() ? ImageVerdict::no_help : ImageVerdict::unknown);
}

/// With what it was decided by.
void tell(const Trial& trial, RefineReport& report) {
    const HeldOutErrors* deciding = trial.deciding();
    if (!deciding) return;
    report.displaced = deciding != (trial.left_out ? &trial.left_out->errors : nullptr);
    report.intensities += deciding->intensities();
    report.planes_left_out = deciding->planes();
    report.error_without_mm = deciding->without_mm();
    report.error_with_mm = deciding->with_mm();
    if (!trial.left_out) return;
    report.intensities += trial.left_out->cells.intensities;
    if (!trial.walk_helps()) return;
    const WrongCells wrong = sum(trial.left_out->wrong);
    report.wrong_without = wrong.alone / wrong.drawn;
    report.wrong_with = wrong.walked / wrong.drawn;
    if (report.walked)
        for (AskedPoint& point : report.asked) point.share = report.share_left();
}

}  // namespace

RefinedFunction refine(const Drawing& drawing, const PreparedContours& prepared, const FittedFunction& fitted,
                       const Image& image, const FitContours& fit_contours, const RefineOptions& options, const Work& work) {
    check_image(image);
    if (is_label_map(image)) return {fitted, {.verdict = ImageVerdict::labels}};
    const DrawnOnImage drawn(drawing, image);
    const Question asked{drawing, prepared, fitted, image, drawn, options, work};
    if (!options.gate) {
        const double voxel = drawn.image.voxel_mm();
        const Beliefs cautious{[](double d) { return kCautiousSlope * d; },
                               [voxel](const MovingPoint&) { return kCautiousImage * voxel; }};
        return asked.moved(asked.asked(cautious), cautious);
    }
    const Trial trial = try_image(asked, fit_contours);
    RefinedFunction result = follow(asked, trial);
    tell(trial, result.report);
    return result;
}

}  // namespace kontur
