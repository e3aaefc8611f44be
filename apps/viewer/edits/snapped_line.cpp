// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/snapped_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/shape/section.h"
#include "kontur/view/reslice.h"

namespace kontur::viewer {
namespace {

constexpr int kMostPoints = 300, kFewestPoints = 24;
constexpr double kStepPixels = 0.5;
constexpr int kMostStepsOn = 3;  ///< by which the movement may change from one point to the next

Point2 operator-(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// A place on a closed line, with the direction out of what it encloses.
struct EdgePoint {
    Point2 at, out;
};

double signed_area(const Polygon2& line) {
    double twice = 0;
    for (std::size_t i = 0, j = line.size() - 1; i < line.size(); j = i++)
        twice += line[j][0] * line[i][1] - line[i][0] * line[j][1];
    return twice / 2;
}

/// `count` places, equally far from each other along the line, their directions those of the line over some steps.
std::vector<EdgePoint> places_on(const Polygon2& line, std::size_t count) {
    std::vector<double> until{0};
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Point2 edge = line[(i + 1) % line.size()] - line[i];
        until.push_back(until.back() + std::hypot(edge[0], edge[1]));
    }
    std::vector<EdgePoint> places(count);
    std::size_t edge = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const double along = until.back() * static_cast<double>(n) / static_cast<double>(count);
        while (edge + 1 < line.size() && until[edge + 1] < along) ++edge;
        const double length = until[edge + 1] - until[edge], share = length > 0 ? (along - until[edge]) / length : 0;
        const Point2 &a = line[edge], &b = line[(edge + 1) % line.size()];
        places[n].at = {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
    }
    const double hand = signed_area(line) > 0 ? 1 : -1;
    for (std::size_t n = 0; n < count; ++n) {
        const Point2 along = places[(n + 2) % count].at - places[(n + count - 2) % count].at;
        const double length = std::hypot(along[0], along[1]);
        if (length > 0) places[n].out = {hand * along[1] / length, -hand * along[0] / length};
    }
    return places;
}

/// The image on a plane, around some places, to be looked up between its pixels.
class Patch {
public:
    Patch(const Image& image, const Plane& plane, const Polygon2& around, double margin_mm, double pixel_mm)
        : pixel_mm_(pixel_mm), from_{around.front()[0], around.front()[1]} {
        Point2 to = around.front();
        for (const Point2& p : around)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                from_[axis] = std::min(from_[axis], p[axis]);
                to[axis] = std::max(to[axis], p[axis]);
            }
        const auto pixels = [&](std::size_t axis) {
            from_[axis] -= margin_mm;
            return static_cast<int>(std::ceil((to[axis] + margin_mm - from_[axis]) / pixel_mm)) + 2;
        };
        width_ = pixels(0), height_ = pixels(1);
        Plane corner = plane;
        corner.origin = plane.from_uv(from_[0], from_[1]);
        const auto outside = static_cast<float>(sample(image, 0));
        values_ = reslice(image, {corner, width_, height_, pixel_mm}, outside);
    }

    double at(double s, double t) const {
        const double x = std::clamp((s - from_[0]) / pixel_mm_, 0.0, width_ - 1.001);
        const double y = std::clamp((t - from_[1]) / pixel_mm_, 0.0, height_ - 1.001);
        const int column = static_cast<int>(x), row = static_cast<int>(y);
        const double right = x - column, down = y - row;
        const auto value = [&](int c, int r) {
            return static_cast<double>(
                values_[static_cast<std::size_t>(r) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(c)]);
        };
        return (1 - down) * ((1 - right) * value(column, row) + right * value(column + 1, row)) +
               down * ((1 - right) * value(column, row + 1) + right * value(column + 1, row + 1));
    }

    /// Values along a place's direction, from `first` to `last` steps out of it.
    std::vector<double> across(const EdgePoint& place, int first, int last, double step_mm) const {
        std::vector<double> values;
        for (int n = first; n <= last; ++n)
            values.push_back(at(place.at[0] + n * step_mm * place.out[0], place.at[1] + n * step_mm * place.out[1]));
        return values;
    }

private:
    double pixel_mm_;
    Point2 from_;
    int width_ = 0, height_ = 0;
    std::vector<float> values_;
};

double deviation(const std::vector<std::vector<double>>& rows) {
    double count = 0, mean = 0, squares = 0;
    for (const auto& row : rows)
        for (const double value : row) {
            const double before = value - mean;
            mean += before / ++count;
            squares += before * (value - mean);
        }
    return count > 0 ? std::sqrt(squares / count) : 0;
}

/// costs[i][m]: of the movement m at place i. Each is averaged over neighbouring places, for the image's noise.
using Costs = std::vector<std::vector<double>>;

Costs averaged(const Costs& costs, int half) {
    Costs result = costs;
    const auto count = static_cast<int>(costs.size());
    for (int i = 0; i < count; ++i)
        for (std::size_t m = 0; m < costs[0].size(); ++m) {
            double sum = 0;
            for (int k = -half; k <= half; ++k) sum += costs[static_cast<std::size_t>((i + k + count) % count)][m];
            result[static_cast<std::size_t>(i)][m] = sum / (2 * half + 1);
        }
    return result;
}

/// The movement of each place by which the sum of costs and bends is least (dynamic programming, twice around, of which the
/// middle counts: there the start is forgotten).
std::vector<int> cheapest(const Costs& costs, double stiffness) {
    const std::size_t count = costs.size(), movements = costs[0].size(), steps = 2 * count;
    std::vector<std::vector<double>> sum(steps, std::vector<double>(movements));
    std::vector<std::vector<int>> came(steps, std::vector<int>(movements));
    sum[0] = costs[0];
    for (std::size_t i = 1; i < steps; ++i)
        for (int m = 0; m < static_cast<int>(movements); ++m) {
            double best = std::numeric_limits<double>::infinity();
            for (int from = std::max(0, m - kMostStepsOn);
                 from <= std::min(static_cast<int>(movements) - 1, m + kMostStepsOn); ++from) {
                const double cost = sum[i - 1][static_cast<std::size_t>(from)] + stiffness * (m - from) * (m - from);
                if (cost < best) best = cost, came[i][static_cast<std::size_t>(m)] = from;
            }
            sum[i][static_cast<std::size_t>(m)] = best + costs[i % count][static_cast<std::size_t>(m)];
        }
    std::vector<int> chosen(count);
    auto at = static_cast<int>(std::ranges::min_element(sum.back()) - sum.back().begin());
    for (std::size_t i = steps; i-- > 0;) {
        if (i >= count / 2 && i < count / 2 + count) chosen[i % count] = at;
        at = came[i][static_cast<std::size_t>(at)];
    }
    return chosen;
}

Polygon2 on(const Plane& plane, const std::vector<Vec3>& points) {
    Polygon2 line;
    for (const Vec3& p : points) line.push_back(plane.to_uv(p));
    return line;
}

}  // namespace

std::vector<Vec3> snapped_line(const LineInPlane& expected_line, const LineInPlane& drawn, const Image& image,
                               const SnapOptions& options) {
    const auto& [line, plane] = expected_line;
    const double pixel_mm = smallest(image.grid.spacing_mm()), step_mm = kStepPixels * pixel_mm;
    const double apart_mm = std::abs(plane.distance_to(drawn.plane.origin));
    const double reach_mm = options.reach_mm > 0 ? options.reach_mm : std::clamp(2 * apart_mm, 2 * pixel_mm, 10 * pixel_mm);
    const Polygon2 expected = on(plane, line);
    // Both lines are looked at in the plane's own (u, v): the drawn one is laid onto it along the normal.
    const Polygon2 known = on(plane, drawn.points);
    if (expected.size() < 3 || known.size() < 3) return line;
    double length = 0;
    for (std::size_t i = 0, j = line.size() - 1; i < line.size(); j = i++) length += distance(line[j], line[i]);
    const auto count = static_cast<std::size_t>(std::clamp(length / pixel_mm, 0.0, 1.0 * kMostPoints));
    if (count < kFewestPoints) return line;

    const int band = static_cast<int>(std::lround(options.band_pixels / kStepPixels));
    const int reach = static_cast<int>(std::lround(reach_mm / step_mm));
    Plane behind = plane;  // where the drawn line lies, with the same axes
    behind.origin += plane.distance_to(drawn.plane.origin) * plane.normal;
    const double margin_mm = (band + reach + 2) * step_mm;
    const Patch here(image, plane, expected, margin_mm, pixel_mm), there(image, behind, known, margin_mm, pixel_mm);
    const std::vector<EdgePoint> places = places_on(expected, count), patterns = places_on(known, 2 * count);
    std::vector<std::vector<double>> looks;  // of the image beside the drawn line
    for (const EdgePoint& one : patterns) looks.push_back(there.across(one, -band, band, step_mm));
    const double contrast = deviation(looks);
    if (!(contrast > 0)) return line;

    Costs costs(count, std::vector<double>(static_cast<std::size_t>(2 * reach + 1)));
    for (std::size_t i = 0; i < count; ++i) {
        const auto nearest = std::ranges::min_element(patterns, {}, [&](const EdgePoint& one) {
            const Point2 away = one.at - places[i].at;
            return std::hypot(away[0], away[1]);
        });
        const std::vector<double>& wanted = looks[static_cast<std::size_t>(nearest - patterns.begin())];
        const std::vector<double> seen = here.across(places[i], -band - reach, band + reach, step_mm);
        for (std::size_t m = 0; m < costs[i].size(); ++m) {
            double off = 0;
            for (std::size_t t = 0; t < wanted.size(); ++t)
                off += std::min(std::abs(seen[m + t] - wanted[t]) / contrast, 2.0);
            const double shift = (static_cast<double>(m) - reach) / reach;
            costs[i][m] = off / static_cast<double>(wanted.size()) + options.stay * shift * shift;
        }
    }
    const std::vector<int> chosen = cheapest(averaged(costs, 3), options.stiffness * kStepPixels * kStepPixels);
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < count; ++i) {
        double shift = 0;
        for (std::size_t k = count - 2; k <= count + 2; ++k) shift += chosen[(i + k) % count] - reach;
        shift *= step_mm / 5;
        result.push_back(
            plane.from_uv(places[i].at[0] + shift * places[i].out[0], places[i].at[1] + shift * places[i].out[1]));
    }
    return result;
}

}  // namespace kontur::viewer
