// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "kontur/fit/fit.h"

namespace kontur {

/// What an image tells of a function f + g that follows it.
struct ImageData {
    std::vector<PointConstraint> values;   ///< of f + g
    std::vector<PointConstraint> changes;  ///< of g
    /// How far f changes at any place, as the surface near it is moved, mm.
    std::function<double(const Vec3&)> change_mm = [](const Vec3&) { return 0.0; };
};

/// Adds what the image says to a fit f. The result is f + g. g is the smoothest function of the same kernel that is 0 at all
/// data of the fit, and elsewhere the image's data less f. That is the minimum of fit and image together, but for one thing:
/// g knows the contours only by points as far apart as the image tells details. A bound at which f is held moves with the
/// surface.
class Refit {
public:
    /// Keeps references to `prepared`, and to `fitted`, a fit to it.
    Refit(const PreparedContours& prepared, const FittedFunction& fitted, const FitOptions& options, double spacing_mm);

    FittedFunction with(const ImageData& data, const Work& work) const;

private:
    std::vector<PointConstraint> changes(const ImageData& data, const Work& work) const;
    const Bound& bound_at(const Vec3& place) const;

    const PreparedContours& prepared_;
    const FittedFunction& fitted_;
    FitOptions options_;
    std::vector<BoundaryPoint> points_;  ///< of the contours, and their slopes
    std::vector<double> slopes_;
    std::size_t contour_constraints_;  ///< constraints of the contours
};

/// The function between two fits of one drawing, of which the second counts so much.
FittedFunction between(const FittedFunction& first, const FittedFunction& second, double share);

/// The largest difference of two functions at drawn points, about 500 of them.
double largest_change(const ImplicitFunction& a, const ImplicitFunction& b, const ContourSet& contours, const Work& work);

}  // namespace kontur
