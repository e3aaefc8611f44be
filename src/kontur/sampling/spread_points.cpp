// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/spread_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "kontur/extract/adaptive.h"
#include "kontur/extract/preview.h"
#include "kontur/sampling/edge_crossings.h"

namespace kontur {
namespace {

constexpr double kTolerance = 0.02;  // of a lattice's values, in spacings

/// Of each cell of a lattice that holds any, the first.
std::vector<std::size_t> one_per_cell(std::span<const Vec3> points, const Vec3& corner, double edge_mm) {
    std::map<std::array<std::int64_t, 3>, std::size_t> first;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 at = (points[i] - corner) / edge_mm;
        const auto cell = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
        first.try_emplace({cell(at.x), cell(at.y), cell(at.z)}, i);
    }
    std::vector<std::size_t> numbers;
    for (const auto& entry : first) numbers.push_back(entry.second);
    return numbers;
}

/// The edge of cells about `count` of which hold points. How many do leaps with the edge, by a few in a hundred, and the
/// edge at which they are just `count` leaps with the points. Every edge of a ladder at which they are half to twice as many
/// says where they are `count`, as cells on a surface grow in number with the inverse square of the edge; the mean follows
/// the points.
double edge_of_cells(std::span<const Vec3> points, const Box3& box, double count) {
    constexpr double kStep = 1.1892071150027210;  // four to an octave
    constexpr int kMostSteps = 32;                // points in one place are never in cells of their own
    if (!(box.diagonal() > 0)) return 1;
    double edge = box.diagonal() / std::sqrt(count), finer = edge;
    double sum = 0, weights = 0;
    const auto cells_of = [&](double edge_mm) {
        const auto cells = static_cast<double>(one_per_cell(points, box.min, edge_mm).size());
        const double weight = std::max(0.0, 1 - std::abs(std::log2(cells / count)));
        sum += weight * (std::log(edge_mm) + 0.5 * std::log(cells / count));
        weights += weight;
        return cells;
    };
    const double first = cells_of(edge);
    const double most = std::min(2 * count, static_cast<double>(points.size()));
    double cells = first;
    for (int step = 0; step < kMostSteps && cells < most; ++step) cells = cells_of(finer /= kStep);
    cells = first;
    for (int step = 0; step < kMostSteps && cells > count / 2; ++step) cells = cells_of(edge *= kStep);
    return weights > 0 ? std::exp(sum / weights) : finer;
}

double side(const Contour& contour, std::size_t i) {
    return distance(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
}

std::size_t sides(const Contour& contour) {
    const std::size_t points = contour.points.size();
    return contour.closed || points == 0 ? points : points - 1;
}

}  // namespace

std::vector<Vec3> points_of_surface(const ImplicitFunction& function, const ContourSet& contours, double spacing_mm,
                                    const Work& work) {
    const Affine3 frame = frame_of(contours), to_frame = frame.inverse();
    std::vector<Vec3> starts, in_frame;
    for (const Contour& contour : contours.contours)
        starts.insert(starts.end(), contour.points.begin(), contour.points.end());
    for (const Vec3& p : starts) in_frame.push_back(to_frame.apply(p));
    std::optional<Grid> grid = preview_lattice(in_frame, spacing_mm);
    if (!grid) return {};
    grid->index_to_mm = compose(frame, grid->index_to_mm);
    FastFunction fast(function,
                      {.tolerance_mm = kTolerance * spacing_mm, .expected_points = expected_surface_voxels(*grid, starts)});
    const SurfaceLattice surface = track_surface_adaptively(fast, *grid, starts, work.untold());
    std::vector<Vec3> points;
    EdgeCrossings(surface).visit([&](const Vec3& point, double) { points.push_back(point); });
    return points;
}

std::vector<Vec3> spread(const std::vector<Vec3>& points, std::size_t count, const Affine3& frame) {
    if (points.size() <= count) return points;
    const Affine3 to_frame = frame.inverse();
    std::vector<Vec3> in_frame;
    for (const Vec3& p : points) in_frame.push_back(to_frame.apply(p));
    const Box3 box = bounding_box(in_frame);
    std::vector<Vec3> some;
    for (const std::size_t i : one_per_cell(in_frame, box.min, edge_of_cells(in_frame, box, static_cast<double>(count))))
        some.push_back(points[i]);
    return some;
}

std::vector<Vec3> slide_to_surface(const ImplicitFunction& function, std::vector<Vec3>& points, const SlideOptions& options,
                                   const Work& work) {
    constexpr double kLeastSlope2 = 0.09;
    std::vector<double> values(points.size());
    std::vector<Vec3> gradients(points.size());
    for (int step = 0; step < options.steps; ++step) {
        function.values_and_gradients(points, values, gradients, work);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3 move = -values[i] / std::max(dot(gradients[i], gradients[i]), kLeastSlope2) * gradients[i];
            const double far = norm(move);
            points[i] += (far > options.reach_mm ? options.reach_mm / far : 1.0) * move;
        }
    }
    return gradients;
}

std::vector<MovingPoint> with_normals(const ImplicitFunction& function, std::span<const Vec3> points, const Work& work) {
    std::vector<Vec3> gradients(points.size());
    function.gradients(points, gradients, work);
    std::vector<MovingPoint> result(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) result[i] = {points[i], -normalized(gradients[i])};
    return result;
}

std::vector<Vec3> along_contours(const ContourSet& contours, double step_mm) {
    constexpr double kLeast = 8;
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours) {
        const double length = length_mm(contour);
        const double count = std::max(kLeast, std::round(length / step_mm));
        const double step = length / count;
        double next = 0, before = 0;
        for (std::size_t i = 0; i < sides(contour); ++i) {
            const Vec3 &a = contour.points[i], &b = contour.points[(i + 1) % contour.points.size()];
            const double along = side(contour, i);
            for (; next < before + along; next += step) points.push_back(a + (next - before) / along * (b - a));
            before += along;
        }
    }
    return points;
}

double length_mm(const Contour& contour) { return line_length(contour.points, contour.closed); }

double length_mm(const ContourSet& contours) {
    double sum = 0;
    for (const Contour& contour : contours.contours) sum += length_mm(contour);
    return sum;
}

double nearest_distance(const Vec3& p, std::span<const Vec3> points) {
    double least2 = std::numeric_limits<double>::infinity();
    for (const Vec3& q : points) least2 = std::min(least2, dot(q - p, q - p));
    return std::sqrt(least2);
}

}  // namespace kontur
