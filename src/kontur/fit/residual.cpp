// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/residual.h"

#include <algorithm>
#include <cmath>

namespace kontur {

Residual residual(const ImplicitFunction& function, const ContourSet& set, const Work& work) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    std::vector<double> values(points.size());
    std::vector<Vec3> gradients(points.size());
    function.values_and_gradients(points, values, gradients, work);

    Residual result;
    double squares = 0;
    std::size_t i = 0;
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        for (const std::size_t end = i + set.contours[c].points.size(); i < end; ++i) {
            const double distance_mm = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
            squares += distance_mm * distance_mm;
            if (distance_mm <= result.max_mm) continue;
            result.max_mm = distance_mm;
            result.worst_contour = c;
        }
    if (!points.empty()) result.rms_mm = std::sqrt(squares / static_cast<double>(points.size()));
    return result;
}

}  // namespace kontur
