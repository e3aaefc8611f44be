// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/solve_placed.h"

namespace kontur {

void solve_placed(const PlacedConstraints& placed, const SolveOptions& options, const Ball3& ball, const Work& work,
                  PreviousSolve& previous, FittedFunction& fitted) {
    SolveOptions in_ball = options;
    if (options.kernel == Kernel::screened && !options.ball) in_ball.ball = ball;
    const Solution solution = solve(placed.constraints, in_ball, work, &previous);
    fitted.function = solution.function;
    fitted.report = solution.report;
    fitted.iterations += solution.report.iterations;
    fitted.merged = placed.merged;
    fitted.constraints = placed.constraints.size();
    ++fitted.solves;
}

}  // namespace kontur
