// SPDX-License-Identifier: Apache-2.0
#include "true_border.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/measure/surface_distance.h"
#include "kontur/sureness/surface_uncertainty.h"

namespace kontur {
namespace {

constexpr std::size_t kBorderRows = 240;

/// A face between a voxel inside and one outside.
struct Face {
    Vec3 middle;  ///< index
    int axis;
};

std::vector<Face> faces(const Mask& mask) {
    std::vector<Face> found;
    const Grid& g = mask.grid;
    for (std::int64_t k = 0; k < g.size.k; ++k)
        for (std::int64_t j = 0; j < g.size.j; ++j)
            for (std::int64_t i = 0; i < g.size.i; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    Index3 next{i, j, k};
                    if (++next[axis] == g.size[axis]) continue;
                    if ((mask.values[g.offset(i, j, k)] != 0) == (mask.values[g.offset(next.i, next.j, next.k)] != 0))
                        continue;
                    Vec3 middle{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
                    middle[axis] += 0.5;
                    found.push_back({middle, axis});
                }
    return found;
}

/// Of a cell between eight voxels: 1 inside, 0 outside; i counts fastest.
using Corners = std::array<double, 8>;

Corners corners(const Mask& mask, const Index3& low) {
    Corners values{};
    for (std::size_t c = 0; c < 8; ++c) {
        const auto n = static_cast<std::int64_t>(c);
        values[c] = mask.values[mask.grid.offset(low.i + (n & 1), low.j + ((n >> 1) & 1), low.k + (n >> 2))] != 0;
    }
    return values;
}

/// Above 0 inside of the 0.5 level of the trilinear interpolation.
double level(const Corners& values, const Vec3& p) {
    double total = 0;
    for (std::size_t c = 0; c < 8; ++c)
        total += values[c] * (c & 1 ? p.x : 1 - p.x) * (c & 2 ? p.y : 1 - p.y) * (c & 4 ? p.z : 1 - p.z);
    return total - 0.5;
}

/// Where the level crosses the edges of a cell's thirds, in the cell's own coordinates.
std::vector<Vec3> crossings(const Corners& values) {
    constexpr int kParts = 3;
    std::vector<Vec3> found;
    if (std::all_of(values.begin(), values.end(), [&](double v) { return v == values[0]; })) return found;
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < kParts * kParts * kParts; ++n) {
            Vec3 from{};
            from[axis] = n % kParts;
            from[(axis + 1) % 3] = n / kParts % kParts;
            from[(axis + 2) % 3] = n / (kParts * kParts);
            from = from / kParts;
            Vec3 to = from;
            to[axis] += 1.0 / kParts;
            const double a = level(values, from), b = level(values, to);
            if ((a > 0) == (b > 0)) continue;
            from[axis] += a / (a - b) / kParts;
            found.push_back(from);
        }
    return found;
}

}  // namespace

BorderPoints points_on_faces(const Mask& mask, int across) {
    BorderPoints border;
    const Affine3& to_mm = mask.grid.index_to_mm;
    for (const Face& face : faces(mask)) {
        const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
        const double area = norm(cross(to_mm.column(u), to_mm.column(v))) / (across * across);
        for (int a = 0; a < across; ++a)
            for (int b = 0; b < across; ++b) {
                Vec3 at = face.middle;
                at[u] += (a + 0.5) / across - 0.5;
                at[v] += (b + 0.5) / across - 0.5;
                border.points.push_back(to_mm.apply(at));
                border.areas_mm2.push_back(area);
            }
    }
    return border;
}

std::vector<Vec3> points_on_level(const Mask& mask) {
    std::vector<Vec3> points;
    const Index3 size = mask.grid.size;
    for (std::int64_t k = 0; k + 1 < size.k; ++k)
        for (std::int64_t j = 0; j + 1 < size.j; ++j)
            for (std::int64_t i = 0; i + 1 < size.i; ++i) {
                const Vec3 low{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
                for (const Vec3& at : crossings(corners(mask, {i, j, k})))
                    points.push_back(mask.grid.index_to_mm.apply(at + low));
            }
    return points;
}

double rounded(double value, double step) { return std::round(value / step) * step; }

nlohmann::ordered_json border_rows(const SurfaceEvidence& e, const TriangleMesh& mesh, const BorderPoints& border) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const std::size_t count = border.points.size(), step = count / kBorderRows + 1;
    std::vector<Vec3> points;
    std::vector<double> areas;
    for (std::size_t n = step / 2; n < count; n += step) {
        points.push_back(border.points[n]);
        areas.push_back(border.areas_mm2[n]);
    }
    const std::vector<Vec3> nearest = nearest_places(points, mesh);
    const std::vector<double> widths = half_widths_mm(e, nearest, {.threads = 1});
    for (std::size_t n = 0; n < widths.size(); ++n)
        rows.push_back({rounded(distance(points[n], nearest[n]) / e.size_mm, 1e-5),
                        rounded(e.lines.distance_to(nearest[n]) / e.size_mm, 1e-5), rounded(areas[n], 1e-3),
                        rounded(e.image.at(nearest[n]), 1e-3), rounded(widths[n] / e.size_mm, 1e-5)});
    return rows;
}

}  // namespace kontur
