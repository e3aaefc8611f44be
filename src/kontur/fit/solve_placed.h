// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/fit/constraints.h"
#include "kontur/fit/fit.h"
#include "kontur/solve/solve.h"

namespace kontur {

/// One solve of a fit: solves for what was placed, with the screened kernel in the ball of what was drawn unless the options
/// have one, and enters function, report and counts in `fitted`. Throws as `solve` does.
void solve_placed(const PlacedConstraints& placed, const SolveOptions& options, const Ball3& ball, const Work& work,
                  PreviousSolve& previous, FittedFunction& fitted);

}  // namespace kontur
