// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/fit/fit.h"

namespace kontur {

/// Adds what the image says to a fit f: f + g, where g is the smoothest function of the same kernel that is 0 in all that
/// the fit knew and elsewhere what f is off the image's data. That is the minimum of fit and image together, but that g
/// knows the contours by points as far apart as the image tells details; f knows all.
class Refit {
public:
    /// Keeps references to `fitted`.
    Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options, double spacing_mm);

    FittedFunction with(const std::vector<PointConstraint>& more, const Work& work) const;

private:
    const FittedFunction& fitted_;
    FitOptions options_;
    std::vector<BoundaryPoint> points_;  ///< of the contours, and their slopes
    std::vector<double> slopes_;
    std::size_t known_;  ///< constraints of the contours
};

/// The function between two fits of one drawing, of which the second counts so much.
FittedFunction between(const FittedFunction& first, const FittedFunction& second, double share);

/// The largest difference of two functions at drawn points, about 500 of them.
double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, const Work& work);

}  // namespace kontur
