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

/// With the errors by which it was decided.
RefinedFunction told_by(const HeldOutErrors& errors, RefinedFunction result) {
    result.report.intensities += errors.intensities();
    result.report.planes_left_out = errors.planes();
    result.report.error_without_mm = errors.without_mm();
    result.report.error_with_mm = errors.with_mm();
    return result;
}

RefinedFunction told_by_displacing(const HeldOutErrors& errors, RefinedFunction result) {
    result.report.displaced = true;
    return told_by(errors, std::move(result));
}

/// What becomes of a drawing, its fit and an image.
struct Question {
    const Drawing& drawing;
    const PreparedContours& prepared;
    const FittedFunction& fitted;
    const Image& image;
    const DrawnOnImage& drawn;
    const RefineOptions& options;
    const Work& work;

    RefinedFunction moved(const Beliefs& beliefs) const {
        return move_surface(drawn, drawing, prepared, fitted, beliefs, options, work);
    }
};

/// The surface moved, if the image helps where planes are left out, or else displaced.
RefinedFunction moved_if_it_helps(const Question& asked, const std::optional<LeftOutPlanes>& left_out) {
    if (left_out && left_out->errors.image_helps())
        return told_by(left_out->errors, asked.moved(left_out->errors.beliefs()));
    const std::optional<HeldOutErrors> displaced =
        displace_planes(asked.drawing, asked.image, asked.fitted.function, asked.work);
    if (displaced && displaced->image_helps(1 - kTakenBack))
        return told_by_displacing(*displaced, asked.moved(displaced->beliefs()));
    const bool is_known = left_out || displaced;
    RefinedFunction unchanged{asked.fitted, {.verdict = is_known ? ImageVerdict::no_help : ImageVerdict::unknown}};
    if (left_out) return told_by(left_out->errors, std::move(unchanged));
    return displaced ? told_by_displacing(*displaced, std::move(unchanged)) : unchanged;
}

RefinedFunction walked(const Question& asked, const LeftOutPlanes& left_out, const RefinedFunction& moved) {
    RefinedFunction result =
        walk_surface({left_out.cells, asked.drawn.walls, left_out.errors.beliefs().prior_mm}, asked.drawing, asked.prepared,
                     asked.fitted, moved, asked.options, asked.drawn.image.voxel_mm(), asked.work);
    const WrongCells wrong = sum(left_out.wrong);
    result.report.wrong_without = wrong.alone / wrong.drawn;
    result.report.wrong_with = wrong.walked / wrong.drawn;
    if (result.report.walked)
        for (AskedPoint& point : result.report.asked) point.share = result.report.share_left();
    return result;
}

}  // namespace

RefinedFunction refine(const Drawing& drawing, const PreparedContours& prepared, const FittedFunction& fitted,
                       const Image& image, const FitContours& fit_contours, const RefineOptions& options, const Work& work) {
    check_image(image);
    if (is_label_map(image)) return {fitted, {.verdict = ImageVerdict::labels}};
    const DrawnOnImage drawn(drawing, image);
    const double voxel = drawn.image.voxel_mm();
    if (!options.gate) {
        const Beliefs cautious{[](double d) { return kCautiousSlope * d; },
                               [voxel](const MovingPoint&) { return kCautiousImage * voxel; }};
        return move_surface(drawn, drawing, prepared, fitted, cautious, options, work);
    }
    const std::optional<LeftOutPlanes> left_out = leave_planes_out(drawing, image, fit_contours, work);
    const Question asked{drawing, prepared, fitted, image, drawn, options, work};
    RefinedFunction result = moved_if_it_helps(asked, left_out);
    if (!left_out) return result;
    result.report.intensities += left_out->cells.intensities;
    return walk_helps(left_out->wrong, result.report.verdict == ImageVerdict::used) ? walked(asked, *left_out, result)
                                                                                    : result;
}

}  // namespace kontur
