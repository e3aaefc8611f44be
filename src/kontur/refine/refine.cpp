// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/point_tree.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/solve_placed.h"
#include "kontur/refine/displace.h"
#include "kontur/refine/leave_out.h"
#include "kontur/refine/movement.h"
#include "kontur/refine/searched_band.h"
#include "kontur/refine/spread_points.h"

namespace kontur {
namespace {

constexpr double kSurfaceSpacing = 0.025;  // of the drawing's diameter: where the surface is asked for
constexpr double kCautiousSlope = 0.12;    // without the gate: prior standard deviation over the distance ...
constexpr double kCautiousImage = 0.7;     // ... and the image's error in voxels
constexpr double kFollow = 0.05;           // noise of a moved point over its posterior standard deviation
constexpr double kLeastDeviation = 0.2;    // voxels
constexpr double kBeside = 2.24;           // how much noisier f is before and behind a moved point
constexpr double kAnchorNoise = 0.1;       // voxels
constexpr std::size_t kCompared = 500;     // drawn points at which functions are
constexpr int kAttempts = 4;               // to keep the surface where the image was asked

/// f at the moved points, and before and behind them, is what it was where they came from.
std::vector<PointConstraint> observations(const Movement& movement, const ImplicitFunction& before, double voxel_mm,
                                          const Work& work) {
    std::vector<Vec3> from;
    for (const MovingPoint& p : movement.points)
        for (const double side : {0.0, 1.0, -1.0}) from.push_back(p.position + side * voxel_mm * p.normal);
    std::vector<double> values(from.size());
    before.values(from, values, work);
    std::vector<PointConstraint> observed;
    for (std::size_t i = 0; i < from.size(); ++i) {
        const std::size_t point = i / 3;
        const double noise = kFollow * std::max(movement.offsets.sd_mm[point], kLeastDeviation * voxel_mm);
        observed.push_back({.position = from[i] + movement.offsets.mean_mm[point] * movement.points[point].normal,
                            .value = values[i],
                            .noise_mm = i % 3 == 0 ? noise : kBeside * noise});
    }
    return observed;
}

/// Where moving points would meet a drawn plane: f stays there what the contours make of it.
std::vector<PointConstraint> anchors(const Movement& movement, const DrawnOnImage& drawn, const ImplicitFunction& fitted,
                                     const Work& work) {
    const double voxel = drawn.image.voxel_mm();
    std::vector<Vec3> places;
    for (const MovingPoint& p : movement.points)
        for (const double wall : {p.least_mm, p.most_mm}) {
            const bool near = std::abs(wall) < std::max(2.5 * p.prior_mm, 2 * voxel) && std::abs(wall) > 0.5 * voxel;
            if (!near) continue;
            const Vec3 place = p.position + wall * p.normal;
            if (nearest_distance(place, drawn.points) > voxel && nearest_distance(place, places) > 1.5 * voxel)
                places.push_back(place);
        }
    std::vector<double> values(places.size());
    fitted.values(places, values, work);
    std::vector<PointConstraint> held;
    for (std::size_t i = 0; i < places.size(); ++i)
        held.push_back({.position = places[i], .value = values[i], .noise_mm = kAnchorNoise * voxel});
    return held;
}

/// The largest difference of two functions at drawn points, about `kCompared` of them.
double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, const Work& work) {
    std::size_t count = 0, next = 0;
    for (const Contour& contour : contours.contours) count += contour.points.size();
    const std::size_t step = std::max<std::size_t>(1, count / kCompared);
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours)
        for (const Vec3& p : contour.points)
            if (next++ % step == 0) points.push_back(p);
    std::vector<double> before(points.size()), after(points.size());
    a.values(points, before, work);
    b.values(points, after, work);
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, std::abs(after[i] - before[i]));
    return largest;
}

/// One more solve, with what the image says beside all that the fit knew.
class Refit {
public:
    Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options)
        : prepared_(prepared), fitted_(fitted), options_(options) {}

    FittedFunction with(std::vector<PointConstraint> more, const Work& work) {
        std::vector<PointConstraint> single = fitted_.held;
        single.insert(single.end(), more.begin(), more.end());
        PlacedConstraints placed = place_constraints(prepared_.points, fitted_.slopes, single, options_.place);
        hold_contours(placed.constraints);
        FittedFunction result = fitted_;
        solve_placed(placed, options_.solve, prepared_.ball, work, previous_, result);
        return result;
    }

private:
    /// Points that yield where contours contradict each other yield to those, and not to the image: f stays there what it
    /// was.
    void hold_contours(ConstraintSet& constraints) const {
        std::size_t place = 0;
        for (const BoundaryPoint& point : prepared_.points) {
            if (place == constraints.size() || constraints.centers[place] != point.position) continue;  // merged
            if (point.trust < 1) {
                constraints.values[place] = fitted_.function.value(point.position);
                constraints.trust[place] = 1;
            }
            ++place;
        }
    }

    const PreparedContours& prepared_;
    const FittedFunction& fitted_;
    const FitOptions& options_;
    PreviousSolve previous_;
};

std::vector<AskedPoint> asked_points(const Movement& movement) {
    std::vector<AskedPoint> asked;
    for (std::size_t i = 0; i < movement.points.size(); ++i) {
        const MovingPoint& p = movement.points[i];
        const double share = std::clamp(movement.offsets.sd_mm[i] / p.prior_mm, 0.0, 1.0);
        asked.push_back({p.position + movement.offsets.mean_mm[i] * p.normal, share});
    }
    return asked;
}

/// As far from the surface as offsets are searched, and as points of it are apart.
SearchedBand searched_band(const std::vector<Vec3>& surface, const DrawnOnImage& drawn, const Beliefs& beliefs,
                           double spacing_mm) {
    const PointTree contours(drawn.points);
    std::vector<double> reach;
    for (const Vec3& p : surface) reach.push_back(kSearched * beliefs.prior_mm(contours.distance_to(p)) + spacing_mm);
    return {surface, std::move(reach)};
}

/// Takes moves back near the places from which the surface ran away, the less the farther off.
void hold_back(Movement& movement, std::span<const Vec3> places) {
    for (std::size_t i = 0; i < movement.points.size(); ++i) {
        const double r = nearest_distance(movement.points[i].position, places) / movement.prior.length_mm;
        movement.offsets.mean_mm[i] *= 1 - std::exp(-0.5 * r * r);
    }
}

/// The image is asked once, as it was where contours were left out: asked again from the moved surface it would be believed
/// twice.
RefinedFunction move_surface(const DrawnOnImage& drawn, const Drawing& drawing, const PreparedContours& prepared,
                             const FittedFunction& fitted, const Beliefs& beliefs, const RefineOptions& options,
                             const Work& work) {
    const double voxel = drawn.image.voxel_mm(), spacing = kSurfaceSpacing * drawing.diameter_mm();
    RefinedFunction result{fitted, {}};
    const std::vector<Vec3> surface = points_of_surface(fitted.function, drawing.contours, spacing, work);
    std::vector<Vec3> points = spread(surface, options.samples, frame_of(drawing.contours));
    slide_to_surface(fitted.function, points, {.reach_mm = spacing}, work);
    work.check();
    Movement movement = find_movement(drawn, fitted.function, points, beliefs, work);
    result.report.intensities = movement.intensities;
    result.report.verdict = ImageVerdict::used;
    if (movement.points.empty()) return result;

    const SearchedBand band = searched_band(surface, drawn, beliefs, spacing);
    const std::vector<PointConstraint> held = anchors(movement, drawn, fitted.function, work);
    Refit refit(prepared, fitted, options.fit);
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        work.check();
        std::vector<PointConstraint> told = observations(movement, fitted.function, voxel, work);
        told.insert(told.end(), held.begin(), held.end());
        FittedFunction moved = refit.with(std::move(told), work);
        const std::vector<Vec3> left =
            band.left_from(points_of_surface(moved.function, drawing.contours, spacing, work), work);
        if (left.empty()) {
            result.fitted = std::move(moved);
            result.report.on_contours_mm = largest_change(fitted.function, result.fitted.function, drawing.contours, work);
            result.report.asked = asked_points(movement);
            for (const double u : movement.offsets.mean_mm)
                result.report.largest_move_mm = std::max(result.report.largest_move_mm, std::abs(u));
            return result;
        }
        hold_back(movement, left);
    }
    result.report.verdict = ImageVerdict::astray;
    return result;
}

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

std::string no_help(const RefineReport& report) {
    if (report.displaced)
        return fmt::format(
            "the image does not help between the contours (a surface displaced by {:.2g} mm at them is {:.2g} mm "
            "off with it); not used",
            report.error_without_mm, report.error_with_mm);
    return fmt::format("the image {} ({:.2g} mm off at left-out contours without it, {:.2g} with it); not used",
                       report.error_with_mm < report.error_without_mm
                           ? "helps too little, or in too few planes, to be sure of it"
                           : "does not help between the contours",
                       report.error_without_mm, report.error_with_mm);
}

std::string used(const RefineReport& report) {
    if (report.planes_left_out == 0) return "the image was used between the contours, without knowing whether it helps";
    if (report.displaced)
        return fmt::format(
            "the image takes a surface displaced by {:.2g} mm at the contours back to {:.2g} mm; used between the "
            "contours",
            report.error_without_mm, report.error_with_mm);
    return fmt::format("the image lowers the error at left-out contours from {:.2g} to {:.2g} mm; used between the contours",
                       report.error_without_mm, report.error_with_mm);
}

}  // namespace

std::string_view name(UseImage use) noexcept { return use == UseImage::off ? "off" : "auto"; }

std::string_view name(ImageVerdict verdict) noexcept {
    switch (verdict) {
        case ImageVerdict::none:
            return "none";
        case ImageVerdict::labels:
            return "labels";
        case ImageVerdict::unknown:
            return "unknown";
        case ImageVerdict::no_help:
            return "no_help";
        case ImageVerdict::astray:
            return "astray";
        case ImageVerdict::used:
            return "used";
    }
    return "?";
}

std::string sentence(const RefineReport& report) {
    switch (report.verdict) {
        case ImageVerdict::none:
            return "the image was not used";
        case ImageVerdict::labels:
            return "the image is a mask or a label map; not used between the contours";
        case ImageVerdict::unknown:
            return "too little is drawn to tell whether the image helps between the contours; not used";
        case ImageVerdict::no_help:
            return no_help(report);
        case ImageVerdict::astray:
            return "the image leads the surface farther from the contours than it was asked for; not used";
        case ImageVerdict::used:
            return used(report);
    }
    return "";
}

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
    const std::optional<HeldOutErrors> held_out = leave_planes_out(drawing, image, fit_contours, work);
    if (held_out && held_out->image_helps())
        return told_by(*held_out, move_surface(drawn, drawing, prepared, fitted, held_out->beliefs(), options, work));
    const std::optional<HeldOutErrors> displaced = displace_planes(drawing, image, fitted.function, work);
    if (displaced && displaced->image_helps(1 - kTakenBack))
        return told_by_displacing(*displaced,
                                  move_surface(drawn, drawing, prepared, fitted, displaced->beliefs(), options, work));
    RefinedFunction unchanged{fitted, {.verdict = held_out || displaced ? ImageVerdict::no_help : ImageVerdict::unknown}};
    if (held_out) return told_by(*held_out, std::move(unchanged));
    return displaced ? told_by_displacing(*displaced, std::move(unchanged)) : unchanged;
}

}  // namespace kontur
