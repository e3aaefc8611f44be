// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/residual.h"

#include <algorithm>
#include <cmath>

namespace kontur {

namespace {

/// Places on the contours, of which `ends[c]` closes those of contour c.
struct Places {
    std::vector<Vec3> points;
    std::vector<std::size_t> ends;
};

Residual residual_at(const ImplicitFunction& function, const Places& places, const Work& work) {
    std::vector<double> values(places.points.size());
    std::vector<Vec3> gradients(places.points.size());
    function.values_and_gradients(places.points, values, gradients, work);

    Residual result;
    double squares = 0;
    std::size_t i = 0;
    for (std::size_t c = 0; c < places.ends.size(); ++c)
        for (; i < places.ends[c]; ++i) {
            const double distance_mm = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
            squares += distance_mm * distance_mm;
            if (distance_mm <= result.max_mm) continue;
            result.max_mm = distance_mm;
            result.worst_contour = c;
        }
    if (i > 0) result.rms_mm = std::sqrt(squares / static_cast<double>(i));
    return result;
}

}  // namespace

Residual residual(const ImplicitFunction& function, const ContourSet& set, const Work& work) {
    Places places;
    for (const Contour& contour : set.contours) {
        places.points.insert(places.points.end(), contour.points.begin(), contour.points.end());
        places.ends.push_back(places.points.size());
    }
    return residual_at(function, places, work);
}

Residual residual_between_points(const ImplicitFunction& function, const ContourSet& set, double long_mm, const Work& work) {
    Places places;
    for (const Contour& contour : set.contours) {
        const std::vector<Vec3>& points = contour.points;
        for (std::size_t i = contour.closed ? 0 : 1; i < points.size(); ++i) {
            const Vec3 &from = points[i > 0 ? i - 1 : points.size() - 1], &to = points[i];
            if (distance(from, to) > long_mm) places.points.push_back(0.5 * (from + to));
        }
        places.ends.push_back(places.points.size());
    }
    return residual_at(function, places, work);
}

}  // namespace kontur
