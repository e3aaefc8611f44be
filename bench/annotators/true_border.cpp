// SPDX-License-Identifier: Apache-2.0
#include "true_border.h"

#include <algorithm>
#include <array>
#include <cmath>

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

Vec3 nearest_on_edge(const Vec3& a, const Vec3& b, const Vec3& p) {
    const Vec3 along = b - a;
    return a + std::clamp(dot(p - a, along) / std::max(dot(along, along), 1e-30), 0.0, 1.0) * along;
}

Vec3 nearest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const Vec3 normal = cross(b - a, c - a);
    const Vec3 foot = p - dot(p - a, normal) / std::max(dot(normal, normal), 1e-30) * normal;
    const auto is_left = [&](const Vec3& from, const Vec3& to) { return dot(cross(to - from, foot - from), normal) >= 0; };
    if (is_left(a, b) && is_left(b, c) && is_left(c, a)) return foot;
    Vec3 nearest = nearest_on_edge(a, b, p);
    for (const Vec3& q : {nearest_on_edge(b, c, p), nearest_on_edge(c, a, p)})
        if (distance(p, q) < distance(p, nearest)) nearest = q;
    return nearest;
}

/// Of a surface with a triangle at least.
Vec3 nearest_place(const TriangleMesh& mesh, const Vec3& p) {
    Vec3 nearest = mesh.points[mesh.triangles.front()[0]];
    double least = distance(p, nearest);
    for (const auto& t : mesh.triangles) {
        const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
        if (distance(p, a) - std::max(distance(a, b), distance(a, c)) > least) continue;
        const Vec3 place = nearest_on_triangle(a, b, c, p);
        if (distance(p, place) < least) {
            least = distance(p, place);
            nearest = place;
        }
    }
    return nearest;
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
    constexpr int kParts = 3;
    std::vector<Vec3> points;
    const Grid& g = mask.grid;
    const auto value = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return mask.values[g.offset(i, j, k)] != 0 ? 1.0 : 0.0;
    };
    for (std::int64_t k = 0; k + 1 < g.size.k; ++k)
        for (std::int64_t j = 0; j + 1 < g.size.j; ++j)
            for (std::int64_t i = 0; i + 1 < g.size.i; ++i) {
                std::array<double, 8> corner{};
                double sum = 0;
                for (std::size_t c = 0; c < 8; ++c) {
                    const auto n = static_cast<std::int64_t>(c);
                    sum += corner[c] = value(i + (n & 1), j + ((n >> 1) & 1), k + (n >> 2));
                }
                if (sum == 0 || sum == 8) continue;
                const auto at = [&](const Vec3& p) {
                    double total = 0;
                    for (std::size_t c = 0; c < 8; ++c)
                        total += corner[c] * (c & 1 ? p.x : 1 - p.x) * (c & 2 ? p.y : 1 - p.y) * (c & 4 ? p.z : 1 - p.z);
                    return total - 0.5;
                };
                for (int axis = 0; axis < 3; ++axis)
                    for (int n = 0; n < kParts * kParts * kParts; ++n) {
                        Vec3 from{};
                        from[axis] = n % kParts;
                        from[(axis + 1) % 3] = n / kParts % kParts;
                        from[(axis + 2) % 3] = n / (kParts * kParts);
                        from = from / kParts;
                        Vec3 to = from;
                        to[axis] += 1.0 / kParts;
                        const double a = at(from), b = at(to);
                        if ((a > 0) == (b > 0)) continue;
                        from[axis] += a / (a - b) / kParts;
                        points.push_back(g.index_to_mm.apply(
                            from + Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
                    }
            }
    return points;
}

double rounded(double value, double step) { return std::round(value / step) * step; }

nlohmann::ordered_json border_rows(const SurfaceEvidence& e, const TriangleMesh& mesh, const BorderPoints& border) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    const std::size_t count = border.points.size(), step = count / kBorderRows + 1;
    std::vector<Vec3> nearest;
    std::vector<double> away, areas;
    for (std::size_t n = step / 2; n < count; n += step) {
        const Vec3& p = border.points[n];
        const Vec3 found = nearest_place(mesh, p);
        nearest.push_back(found);
        away.push_back(distance(p, found));
        areas.push_back(border.areas_mm2[n]);
    }
    const std::vector<double> widths = half_widths_mm(e, nearest, {.threads = 1});
    for (std::size_t n = 0; n < widths.size(); ++n)
        rows.push_back({rounded(away[n] / e.size_mm, 1e-5), rounded(e.lines.distance_to(nearest[n]) / e.size_mm, 1e-5),
                        rounded(areas[n], 1e-3), rounded(e.image.at(nearest[n]), 1e-3),
                        rounded(widths[n] / e.size_mm, 1e-5)});
    return rows;
}

}  // namespace kontur
