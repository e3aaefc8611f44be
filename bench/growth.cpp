// SPDX-License-Identifier: Apache-2.0
#include "growth.h"

#include <fmt/format.h>

#include <random>

#include "kontur/drawing/orient.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/prepare.h"
#include "kontur/phantom/dense_liver.h"
#include "kontur/solve/kernel_matrix.h"
#include "kontur/solve/solve.h"
#include "machine.h"
#include "published.h"
#include "runs.h"

namespace kontur::bench {
namespace {

constexpr std::size_t kSizes[] = {1000, 2000, 5000, 10000, 20000, 50000, 100000, 200000, 500000, 1000000};
constexpr std::size_t kMostByHand = 200000;  // beyond, the hands' contradictions ask for more digits than there are
constexpr double kTolerance_mm = 0.05;
constexpr double kMergeDistance_mm = 0.1;

ConstraintSet constraints_of(const DenseLiver& liver) {
    // `prepare` would thin contours of so many points.
    std::vector<BoundaryPoint> points;
    for (const Contour& contour : dense_liver_case(liver).contours.contours) {
        const ContourOrientation orientation = orient(contour);
        for (std::size_t i = 0; i < contour.points.size(); ++i)
            points.push_back({.position = contour.points[i], .inplane_normal = orientation.normals[i]});
    }
    const std::vector<double> slopes(points.size(), 1.0);
    return place_constraints(points, slopes, {}, {.normal_offset_mm = 1, .merge_distance_mm = kMergeDistance_mm})
        .constraints;
}

/// Kernel values that one core sums per second when nothing else limits it: the direct product, which reads what it needs
/// from the fastest cache. Each is used twice.
double peak_rate() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::vector<Vec3> points(8192);
    for (Vec3& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
    const DirectKernelMatrix matrix(SolveOptions{}.kernel, PointArrays(points), {.threads = 1});
    std::vector<double> weights(points.size(), 1.0), out(points.size());
    return matrix.evaluations() / measure(9, [&] { matrix.multiply(weights, out); }).cpu_seconds;
}

Json row(const DenseLiver& liver, int repeat, double peak) {
    const ConstraintSet constraints = constraints_of(liver);
    fmt::print(stderr, "kontur_bench: growth, {} constraints{}\n", constraints.size(), liver.by_hand ? " by hand" : "");
    SolveOptions options;
    options.smoothing = 0;
    options.tolerance_mm = kTolerance_mm;
    SolveReport report;
    const PeakMemory memory;
    const Timing timing = measure(repeat, [&] { report = solve(constraints, options).report; });
    const double added_mb = memory.added_mb();
    Json seconds;
    for (const auto& [stage, value] : report.seconds) seconds[stage] = value;
    const int threads = thread_counts().back();
    return {{"drawn", liver.by_hand ? "orthogonal, by hand" : "parallel"},
            {"n", constraints.size()},
            {"threads", threads},
            {"seconds", timing.seconds},
            {"cpu_s", timing.cpu_seconds},
            {"runs", timing.runs},
            {"stages_of_last_run", seconds},
            {"iterations", report.iterations},
            {"residual_mm", report.residual},
            {"residual_points", report.residual_points},
            {"matrix_mb", report.matrix_mb},
            {"added_mb", added_mb},
            {"evaluations_per_product", report.evaluations},
            {"products_at_peak_s", report.iterations * report.evaluations / (peak * threads)}};
}

}  // namespace

Json growth(std::size_t most, int repeat) {
    const double peak = peak_rate();
    Json rows = Json::array();
    for (const bool by_hand : {false, true})
        for (const std::size_t n : kSizes)
            if (n <= most && (!by_hand || n <= kMostByHand))
                rows.push_back(row({.points = n / 2, .orthogonal = by_hand, .by_hand = by_hand}, repeat, peak));
    return {{"tolerance_mm", kTolerance_mm}, {"peak_evaluations_per_s_and_core", peak}, {"rows", rows}};
}

}  // namespace kontur::bench
