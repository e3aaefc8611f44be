// SPDX-License-Identifier: Apache-2.0
// The fit with all of its own options, which the pipeline chooses for itself, and the editor, which chooses others.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "fuzz/drawings.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/editor.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/pipeline.h"

namespace kontur::fuzz {
namespace {

void require(bool holds, const char* promise) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

/// Mostly what makes sense; now and then what does not, which is to be refused.
double odd(Choices& choose, double sound) {
    if (choose.below(32) != 1) return sound;
    constexpr double kOdd[] = {
        0, -1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300, 1e-300};
    return kOdd[choose.below(6)];
}

PrepareOptions prepare_options(Choices& choose, double diameter) {
    PrepareOptions options;
    options.quality = choose.flag() ? 1 : odd(choose, choose.between(0.05, 1));
    options.least_segments = choose.below(50) - 1;
    options.bounds = choose.below(4) != 1;
    options.copy_shift_mm = choose.below(4) == 1 ? odd(choose, 0.005 * diameter) : 0;
    options.gaps = choose.below(4) != 1;
    options.reconcile.conflicts = Conflicts::exact;  // another one follows
    options.click_margin_mm = odd(choose, 0.0045 * diameter);
    options.corners = choose.flag() ? Corners::faithful : Corners::rounded;
    options.corner_spacing_mm = odd(choose, 0.0012 * diameter);
    return options;
}

std::size_t few(Choices& choose) {
    constexpr std::size_t kFew[] = {1000, 8, 1, 20, 100, 3, 40};
    return kFew[choose.below(7)];
}

/// Of a system that the last fit may have to solve: every point, and every bound, all of which f may leave.
std::size_t most_constraints(const PreparedContours& prepared) { return prepared.points.size() + prepared.bounds.size(); }

FitOptions fit_options(Choices& choose, double diameter, const PreparedContours& prepared) {
    const std::size_t points = prepared.points.size();
    FitOptions options;
    options.normals = choose.below(4) == 1 ? Normals::in_plane : Normals::surface;
    options.rounds = choose.below(5) - (choose.below(32) == 1 ? 3 : 0);
    options.start_smoothing = odd(choose, 1e-3);
    options.smoothing_factor = odd(choose, choose.between(0, 1));
    options.least_slope = odd(choose, choose.between(0.05, 1));
    options.early_tolerance_factor = odd(choose, 30);
    options.tilt_points = choose.below(32) == 1 ? 0 : few(choose);
    options.most_points = choose.flag() ? few(choose) : 0;
    options.most_solves = 1 + choose.below(4) - (choose.below(32) == 1 ? 5 : 0);
    if (choose.below(4) == 1) {
        options.start_slopes.assign(points + (choose.below(16) == 1 ? 1 : 0), choose.between(0.1, 1));
        options.start_slopes.front() = odd(choose, 0.5);
    }
    options.normal_offset_mm = odd(choose, choose.between(1e-4, 0.02) * diameter);
    options.merge_distance_mm = choose.flag() ? 0 : odd(choose, 6e-4 * diameter);
    options.solve.kernel = static_cast<Kernel>(choose.below(3));
    // Dense ones take n^3: some seconds each for the 4,000 of a drawing of 147 points, with the sanitizers.
    if (most_constraints(prepared) < 1200) options.solve.solver = static_cast<Solver>(choose.below(4));
    options.solve.smoothing = choose.flag() ? odd(choose, 1e-5) : 0;
    options.solve.tolerance_mm = odd(choose, 1e-4 * diameter);
    options.solve.max_iterations = 1 + choose.below(200);
    return options;
}

void check(const FittedFunction& fitted, const PreparedContours& prepared, const Vec3& middle) {
    require(fitted.slopes.size() == prepared.points.size(), "one slope for each point");
    require(std::isfinite(fitted.function.value(middle)), "a finite value amid the contours");
}

/// An edit after another: the second preview knows slopes of the first.
void edit(Choices& choose, const ContourSet& set) {
    EditorOptions options;
    options.preview_points = few(choose);
    options.preview_spacing_mm = diameter_mm(set) / (4 + choose.below(12));
    Editor editor(options);
    require(editor.preview(set).function.weights().size() > 0, "a function through contours");
    ContourSet next = set;
    if (choose.flag()) next.contours.erase(next.contours.begin() + choose.below(static_cast<int>(next.contours.size())));
    else next.contours.push_back(next.contours.front());
    static_cast<void>(editor.preview(next));
}

}  // namespace

void fitting(Bytes bytes) {
    Choices choose(bytes);
    const bool edits = choose.below(4) == 1;
    ContourSet set = choose.below(4) == 1 ? wild_drawing(choose) : mixed_drawing(choose);
    check_contours(set);
    if (edits) return edit(choose, set);
    const Drawing drawing = read_drawing(set, choose.flag() ? FillRule::declared : FillRule::even_odd);
    const double diameter = drawing.diameter_mm();
    PreparedContours prepared = prepare(drawing, prepare_options(choose, diameter));
    const ReconcileOptions reconciling{.conflicts = static_cast<Conflicts>(choose.below(3)),
                                       .offset_mm = odd(choose, 0.0045 * diameter)};
    reconcile(prepared.points, drawing.crossings, diameter, reconciling);
    check(fit(prepared, fit_options(choose, diameter, prepared)), prepared, drawing.ball.center);
}

}  // namespace kontur::fuzz
