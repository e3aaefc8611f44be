// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/residual.h"

#include <algorithm>
#include <cmath>

namespace kontur {

Residual residual(const ImplicitFunction& function, const ContourSet& set, int threads) {
    Residual result;
    double squares = 0;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        const std::vector<Vec3>& points = set.contours[c].points;
        std::vector<double> values(points.size());
        std::vector<Vec3> gradients(points.size());
        function.values(points, values, threads);
        function.gradients(points, gradients, threads);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double distance_mm = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
            squares += distance_mm * distance_mm;
            if (distance_mm <= result.max_mm) continue;
            result.max_mm = distance_mm;
            result.worst_contour = c;
        }
    }
    const std::size_t count = point_count(set);
    if (count > 0) result.rms_mm = std::sqrt(squares / static_cast<double>(count));
    return result;
}

}  // namespace kontur
