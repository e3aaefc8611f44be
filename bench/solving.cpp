// SPDX-License-Identifier: Apache-2.0
#include "experiments.h"
#include "published.h"
#include "runs.h"

#include "kontur/solve/solve.h"

namespace kontur::bench {
namespace {

ConstraintSet published_constraints(const PhantomCase& phantom) {
    const PreparedContours contours = published_contours(phantom, 1);
    const std::vector<double> slopes(contours.points.size(), 1.0);
    return place_constraints(contours.points, slopes, {}, published_placing()).constraints;
}

}  // namespace

Json solving(const PhantomCase& phantom, int repeat) {
    constexpr std::size_t kPolynomialRows = 4;
    const ConstraintSet constraints = published_constraints(phantom);
    Json rows = Json::array();
    for (const Solver solver : {Solver::dense, Solver::cholesky, Solver::iterative})
        for (const int threads : thread_counts()) {
            if (solver == Solver::dense && threads > 1) continue;  // dsysv runs on one thread
            SolveOptions options;
            options.kernel = Kernel::triharmonic;
            options.solver = solver;
            options.smoothing = 0;
            options.tolerance_mm = 1e-3;
            SolveReport report;
            const Timing timing =
                measure(repeat, [&] { report = solve(constraints, options, {.threads = threads}).report; });
            rows.push_back({{"case", phantom.name},
                            {"n", constraints.size() + kPolynomialRows},
                            {"solver", name(solver)},
                            {"threads", threads},
                            {"seconds", timing.seconds},
                            {"cpu_s", timing.cpu_seconds},
                            {"runs", timing.runs},
                            {"iterations", report.iterations},
                            {"residual_mm", report.residual},
                            {"matrix_mb", report.matrix_mb}});
        }
    return rows;
}

}  // namespace kontur::bench
