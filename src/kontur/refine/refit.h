// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/fit/solve_placed.h"

namespace kontur {

/// One more solve, with what the image says beside all that the fit knew. Keeps references to what it is made of.
class Refit {
public:
    Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options)
        : prepared_(prepared), fitted_(fitted), options_(options) {}

    FittedFunction with(const std::vector<PointConstraint>& more, const Work& work);

private:
    void hold_contours(ConstraintSet& constraints) const;

    const PreparedContours& prepared_;
    const FittedFunction& fitted_;
    const FitOptions& options_;
    PreviousSolve previous_;
};

/// The largest difference of two functions at drawn points, about 500 of them.
double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, const Work& work);

}  // namespace kontur
