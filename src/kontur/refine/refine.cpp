// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/fit/constraints.h"
#include "kontur/fit/solve_placed.h"
#include "kontur/refine/leave_out.h"
#include "kontur/refine/movement.h"
#include "kontur/refine/spread_points.h"

namespace kontur {
namespace {

constexpr double kSurfaceSpacing = 0.025;  // of the drawing's diameter: where the surface is asked for
constexpr double kLater = 0.7;             // of the prior's standard deviation, in later rounds
constexpr double kCautiousSlope = 0.12;    // without the gate: prior standard deviation over the distance ...
constexpr double kCautiousImage = 0.7;     // ... and the image's error in voxels
constexpr double kFollow = 0.05;           // noise of a moved point over its posterior standard deviation
constexpr double kLeastDeviation = 0.2;    // voxels
constexpr double kBeside = 2.24;           // how much noisier f is before and behind a moved point
constexpr double kAnchorNoise = 0.1;       // voxels

/// f at the moved points, and before and behind them, is what it was where they came from.
std::vector<PointConstraint> observations(const Movement& movement, const ImplicitFunction& before, double voxel_mm,
                                          int threads) {
    std::vector<Vec3> from;
    for (const MovingPoint& p : movement.points)
        for (const double side : {0.0, 1.0, -1.0}) from.push_back(p.position + side * voxel_mm * p.normal);
    std::vector<double> values(from.size());
    before.values(from, values, threads);
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
                                     int threads) {
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
    fitted.values(places, values, threads);
    std::vector<PointConstraint> held;
    for (std::size_t i = 0; i < places.size(); ++i)
        held.push_back({.position = places[i], .value = values[i], .noise_mm = kAnchorNoise * voxel});
    return held;
}

/// The largest difference of two functions at the drawn points.
double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, int threads) {
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours)
        points.insert(points.end(), contour.points.begin(), contour.points.end());
    std::vector<double> before(points.size()), after(points.size());
    a.values(points, before, threads);
    b.values(points, after, threads);
    double largest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, std::abs(after[i] - before[i]));
    return largest;
}

/// One more solve, with what the image says beside all that the fit knew.
class Refit {
public:
    Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options)
        : prepared_(prepared), fitted_(fitted), options_(options) {}

    FittedFunction with(std::vector<PointConstraint> more, const Progress& progress) {
        std::vector<PointConstraint> single = fitted_.held;
        single.insert(single.end(), more.begin(), more.end());
        PlacedConstraints placed = place_constraints(prepared_.points, fitted_.slopes, single, options_.place);
        hold_contours(placed.constraints);
        FittedFunction result = fitted_;
        solve_placed(placed, options_.solve, prepared_.ball, progress, previous_, result);
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

RefinedFunction move_surface(const DrawnOnImage& drawn, const Drawing& drawing, const PreparedContours& prepared,
                             const FittedFunction& fitted, const Beliefs& beliefs, const RefineOptions& options,
                             const Progress& progress) {
    const int threads = options.fit.solve.threads;
    const double voxel = drawn.image.voxel_mm();
    RefinedFunction result{fitted, {}};
    Refit refit(prepared, fitted, options.fit);
    std::vector<Vec3> points = spread_over_surface(fitted.function, drawing.contours, options.samples,
                                                   kSurfaceSpacing * drawing.diameter_mm(), threads);
    Beliefs now = beliefs;
    for (int round = 0; round < options.rounds; ++round) {
        progress.check();
        const ImplicitFunction before = result.fitted.function;
        slide_to_surface(before, points, 2 * voxel, threads);
        const Movement movement = find_movement(drawn, before, points, now, threads);
        if (movement.points.empty()) break;
        result.report.intensities += movement.intensities;
        for (const double u : movement.offsets.mean_mm)
            result.report.largest_move_mm = std::max(result.report.largest_move_mm, std::abs(u));
        std::vector<PointConstraint> told = observations(movement, before, voxel, threads);
        const std::vector<PointConstraint> held = anchors(movement, drawn, fitted.function, threads);
        told.insert(told.end(), held.begin(), held.end());
        result.fitted = refit.with(std::move(told), progress);
        now.prior_mm = [&beliefs, scale = std::pow(kLater, round + 1)](double d) { return scale * beliefs.prior_mm(d); };
    }
    result.report.verdict = ImageVerdict::used;
    result.report.on_contours_mm = largest_change(fitted.function, result.fitted.function, drawing.contours, threads);
    return result;
}

}  // namespace

std::string_view name(UseImage use) noexcept { return use == UseImage::off ? "off" : "auto"; }

std::string_view name(ImageVerdict verdict) noexcept {
    switch (verdict) {
        case ImageVerdict::none:
            return "none";
        case ImageVerdict::unknown:
            return "unknown";
        case ImageVerdict::no_help:
            return "no_help";
        case ImageVerdict::used:
            return "used";
    }
    return "?";
}

std::string sentence(const RefineReport& report) {
    switch (report.verdict) {
        case ImageVerdict::none:
            return "the image was not used";
        case ImageVerdict::unknown:
            return "too little is drawn to tell whether the image helps between the contours; not used";
        case ImageVerdict::no_help:
            return fmt::format(
                "the image does not help between the contours ({:.2g} mm off at left-out contours without it, "
                "{:.2g} with it); not used",
                report.error_without_mm, report.error_with_mm);
        case ImageVerdict::used:
            break;
    }
    if (report.planes_left_out == 0) return "the image was used between the contours, without knowing whether it helps";
    return fmt::format("the image lowers the error at left-out contours from {:.2g} to {:.2g} mm; used between the contours",
                       report.error_without_mm, report.error_with_mm);
}

RefinedFunction refine(const Drawing& drawing, const PreparedContours& prepared, const FittedFunction& fitted,
                       const Image& image, const FitContours& fit_contours, const RefineOptions& options,
                       const Progress& progress) {
    check_image(image);
    const DrawnOnImage drawn(drawing, image);
    const double voxel = drawn.image.voxel_mm();
    if (!options.gate) {
        const Beliefs cautious{[](double d) { return kCautiousSlope * d; },
                               [voxel](const MovingPoint&) { return kCautiousImage * voxel; }};
        return move_surface(drawn, drawing, prepared, fitted, cautious, options, progress);
    }
    const std::optional<HeldOutErrors> errors =
        leave_planes_out(drawing, image, fit_contours, options.fit.solve.threads, progress);
    RefinedFunction result{fitted, {}};
    if (errors && errors->image_helps())
        result = move_surface(drawn, drawing, prepared, fitted, errors->beliefs(), options, progress);
    else result.report.verdict = errors ? ImageVerdict::no_help : ImageVerdict::unknown;
    if (errors) {
        result.report.intensities += errors->intensities();
        result.report.planes_left_out = errors->planes();
        result.report.error_without_mm = errors->without_mm();
        result.report.error_with_mm = errors->with_mm();
    }
    return result;
}

}  // namespace kontur
