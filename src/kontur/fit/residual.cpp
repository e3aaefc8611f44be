// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/residual.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kontur/drawing/inner_lines.h"

namespace kontur {

namespace {

/// Places on the contours, of which `ends[c]` closes those of contour c.
struct Places {
    std::vector<Vec3> points;
    std::vector<Vec3> along;  ///< the line's direction
    std::vector<std::size_t> ends;

    void append(const Vec3& point, const Vec3& direction) {
        points.push_back(point);
        along.push_back(direction);
    }
};

/// Whether places lie on lines that are no border. They are asked only where the surface is off the line: mostly none.
class Borders {
public:
    Borders(const ContourSet& set, const std::optional<Grid>& image) : set_(set), image_(image_of(set, image)) {}

    bool is_inner(std::size_t contour, const Vec3& place, const Vec3& along) {
        const Vec3 across = cross(set_.contours[contour].plane.normal, along);
        if (!(norm(across) > 0)) return false;
        const Vec3 outward = normalized(across);
        if (image_ && set_.contours[contour].closed &&
            (image_->is_border(place, outward) || image_->is_border(place, -outward)))
            return true;
        if (!lines_) lines_.emplace(planes());
        return lines_->has(contour, place, outward, planes().tolerance_mm);
    }

    double counted_mm() { return planes().tolerance_mm; }

private:
    const DrawnPlanes& planes() {
        if (!planes_) planes_.emplace(set_);
        return *planes_;
    }

    const ContourSet& set_;
    std::optional<ImageBox> image_;
    std::optional<DrawnPlanes> planes_{};
    std::optional<InnerLines> lines_{};
};

Residual residual_at(const ImplicitFunction& function, const Places& places, Borders borders, const Work& work) {
    std::vector<double> values(places.points.size());
    std::vector<Vec3> gradients(places.points.size());
    function.values_and_gradients(places.points, values, gradients, work);

    Residual result;
    if (places.points.empty()) return result;
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t c = 0, i = 0; c < places.ends.size(); ++c)
        for (; i < places.ends[c]; ++i) {
            const double distance_mm = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
            if (distance_mm > borders.counted_mm() && borders.is_inner(c, places.points[i], places.along[i])) continue;
            ++count;
            squares += distance_mm * distance_mm;
            if (distance_mm <= result.max_mm) continue;
            result.max_mm = distance_mm;
            result.worst_contour = c;
        }
    if (count > 0) result.rms_mm = std::sqrt(squares / static_cast<double>(count));
    return result;
}

}  // namespace

Residual residual(const ImplicitFunction& function, const ContourSet& set, const Work& work,
                  const std::optional<Grid>& image) {
    Places places;
    for (const Contour& contour : set.contours) {
        const std::vector<Vec3>& points = contour.points;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::size_t before = i > 0 ? i - 1 : points.size() - 1, after = i + 1 < points.size() ? i + 1 : 0;
            places.append(points[i], points[after] - points[before]);
        }
        places.ends.push_back(places.points.size());
    }
    return residual_at(function, places, Borders(set, image), work);
}

Residual residual_between_points(const ImplicitFunction& function, const ContourSet& set, double long_mm, const Work& work,
                                 const std::optional<Grid>& image) {
    Places places;
    for (const Contour& contour : set.contours) {
        const std::vector<Vec3>& points = contour.points;
        for (std::size_t i = contour.closed ? 0 : 1; i < points.size(); ++i) {
            const Vec3 &from = points[i > 0 ? i - 1 : points.size() - 1], &to = points[i];
            if (distance(from, to) > long_mm) places.append(0.5 * (from + to), to - from);
        }
        places.ends.push_back(places.points.size());
    }
    return residual_at(function, places, Borders(set, image), work);
}

}  // namespace kontur
