// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kontur/drawing/boundary_point.h"
#include "kontur/drawing/conflicts.h"
#include "kontur/shape/crossings.h"

namespace kontur {

/// What contours disagree by without a contradiction, of the diameter of what was drawn.
inline constexpr double kMarginFraction = 4.5e-3;

struct ReconcileOptions {
    Conflicts conflicts = Conflicts::reconcile;
    std::optional<double> offset_mm{};  ///< > 0: disagreements far below it do not matter; unset: kMarginFraction
    double strength = 100;  ///< a point in the middle of a disagreement as large as the offset gets 1 / (1 + strength) trust
    double reach = 3;       ///< how far around a crossing, in multiples of the disagreement, contours yield
};

/// Lowers the trust in the points about every crossing at which contours disagree, by the square of the disagreement, as
/// for measurement errors. So smoothing follows the measured disagreement, and acts only there. The granted noise (1 /
/// sqrt of the trust) fades with the square of the way from the edge. So a point that a drag moves towards a crossing
/// loses trust gradually. Elsewhere contours keep their trust. Of two that both yield, the more trusted one
/// (Contour::weight) yields less: with trusts v and w the first gets 2 w / (v + w) times what equal ones yield.
/// `crossings` are those of find_crossings on the set that the points were made from. O(points * crossings of their
/// contour). Throws Error(invalid_input) for an offset or reach that is not above 0, a strength below 0, and any that is
/// not finite.
void reconcile(std::vector<BoundaryPoint>& points, std::span<const Crossing> crossings, double diameter_mm,
               const ReconcileOptions& options = {});

}  // namespace kontur
