// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/normals.h"
#include "kontur/fit/prepare.h"
#include "kontur/solve/solve.h"

namespace kontur {

struct FitOptions {
    Normals normals = Normals::surface;
    int rounds = 2;                      ///< surface normals: how often the tilts are read from the fit and given back to it
    double start_smoothing = 1e-2;       ///< surface normals: smoothing of the first fit, on unit coordinates
    double smoothing_factor = 0.3;       ///< ... and its factor from round to round; the last fit has `solve.smoothing`
    double least_slope = 0.2;            ///< surface normals: lower bound of the cosine of the tilt
    double early_tolerance_factor = 30;  ///< surface normals: the rounds before the last only have to show the tilt
    std::size_t tilt_points = 1000;      ///< surface normals: about how many of the points take part in these rounds
    std::vector<double> start_slopes{};  ///< surface normals: known slopes, one per boundary point; empty: all 1
    std::vector<std::size_t> start_bounds{};  ///< without rounds: the bounds at which f is held in the first solve
    std::size_t most_points = 0;              ///< the last fit uses about as many points; 0: all
    /// Without `most_points`: the last fit leaves out points that the others of their line show as exactly as this, and all
    /// points take part where it misses one of them by twice as much. 0: none; unset: 1e-4 of the drawing's diameter with
    /// surface normals and smoothing, else 0.
    std::optional<double> line_tolerance_mm{};
    int most_solves = 2;  ///< with all points, while other bounds should be held than were; 1: whatever is held
    /// By so much f may leave a bound, or be held where it would keep one: it is not solved again for less. Unset: twice the
    /// solver's tolerance.
    std::optional<double> bounds_tolerance_mm{};
    /// Length d > 0 of the normal constraints; unset: 1.35 % of the drawing's diameter, with in-plane normals 0.45 %.
    std::optional<double> normal_offset_mm{};
    std::optional<bool> both_sides{};  ///< normal constraints inside as well as outside; unset: with surface normals
    std::optional<double> normal_spacing_mm{};  ///< of PlaceOptions; unset: 0.75 d, with in-plane normals 0
    std::optional<double> slope_noise{};        ///< of PlaceOptions; unset: 0.21, with in-plane normals 0
    std::optional<double> merge_distance_mm{};  ///< of PlaceOptions; unset: kMergeFraction of the drawing's diameter
    SolveOptions solve{};
};

/// The same options with what is not given for a drawing of this diameter. Throws as check_place_options.
FitOptions resolved(FitOptions options, double diameter_mm);

/// How the constraints of such a fit are placed. The options are to be resolved.
PlaceOptions place_options(const FitOptions& options);

/// An implicit function through contours, and how it was found.
struct FittedFunction {
    ImplicitFunction function;
    SolveReport report;                          ///< of the last solve
    int solves = 0;                              ///< of any part of the points
    int full_solves = 0;                         ///< of all points
    int iterations = 0;                          ///< over all solves
    std::size_t merged = 0;                      ///< near-duplicate constraints left out
    std::size_t bounded = 0;                     ///< bounds at which f is held
    std::size_t constraints = 0;                 ///< kept
    double tilt_change_degrees = 0;              ///< mean change of the tilts in the last round
    std::vector<double> slopes;                  ///< cosine of the surface's tilt, one per boundary point
    std::vector<PointConstraint> active_bounds;  ///< at which f is held, as they took part in the last solve
};

/// Throws Error(invalid_input) for counts below 0, factors and lengths that are not finite or make no sense, slopes outside
/// of (0, 1] or not one for each of the points, and what check_place_options and check_solve_options refuse of what is
/// given.
void check_fit_options(const FitOptions& options, std::size_t points);

/// Fits the implicit function to prepared contours. A contour fixes only the in-plane part of the surface's
/// direction. The paper prescribes f(c + d n_inplane) = -d, which is wrong by the cosine of the tilt. Where
/// contours of different planes cross, these errors contradict each other. With surface normals the tilt is
/// read from the fitted gradient at the contour's points. The prescribed values become f(c + d n_inplane) = -d
/// cos(tilt), and the fit is repeated, two rounds by default. The tilt varies slowly along a contour, so these
/// rounds need only a part of the points. To first order that is the normal constraint of the true 3D normal.
/// But only the contour's own direction is prescribed: the tilt stays free, so jagged contours cannot amplify
/// it (docs/decisions/0001-surface-normals.md). The first fits are smoothed, because the start contradicts
/// itself. A tilt counts as far as the drawn lines are smooth over the distance that it is read from
/// (believed_slopes).
///
/// Where f leaves the interval of a bound after a solve, the bound becomes a datum with noise of the next one,
/// as long as f leans on it. Solves of a part of the points settle which bounds these are, since the fit of all
/// points costs the most. Interior and exterior points are bounds of the same kind. Throws Error as
/// check_fit_options, place_constraints and solve do.
FittedFunction fit(const PreparedContours& contours, const FitOptions& options = {}, const Work& work = {});

}  // namespace kontur
