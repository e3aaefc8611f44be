// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "kontur/function/implicit_function.h"

namespace kontur {

/// Lattice spacings (unit frame) of the far fields to evaluate through, finest first; each one's nodes are evaluated
/// through the next, the last one's directly. Empty: direct sums are cheapest.
struct EvaluationPlan {
    std::vector<double> spacings;
    double cost = 0;  ///< estimate, in kernel values
};

/// The cheapest plan for `points` points on the surface that the centres lie on, of lattices no coarser than a spacing.
EvaluationPlan plan_evaluation(const ImplicitFunction& function, double points,
                               double coarsest_spacing = std::numeric_limits<double>::infinity());

}  // namespace kontur
