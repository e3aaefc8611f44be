// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "kontur/shape/mesh.h"

namespace kontur::test {

/// Triangulated unit sphere by subdividing an octahedron `levels` times: 8 * 4^levels triangles, exact vertices on the
/// sphere.
inline TriangleMesh unit_sphere(int levels) {
    TriangleMesh mesh;
    mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.points.size()));
            if (is_new) mesh.points.push_back(normalized(mesh.points[a] + mesh.points[b]));
            return it->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    mesh.normals = mesh.points;
    return mesh;
}

inline TriangleMesh ball(const Vec3& center, double radius, int levels) {
    TriangleMesh mesh = unit_sphere(levels);
    for (Vec3& p : mesh.points) p = center + radius * p;
    return mesh;
}

/// A star-shaped body: the surface point in direction d lies at `center` + radius(d) * d. Without normals.
inline TriangleMesh star(const Vec3& center, int levels, const std::function<double(const Vec3&)>& radius) {
    TriangleMesh mesh = unit_sphere(levels);
    for (Vec3& p : mesh.points) p = center + radius(p) * p;
    mesh.normals.clear();
    return mesh;
}

/// A torus about the z axis through `center`, with `n` x `n` points.
inline TriangleMesh torus(const Vec3& center, double major, double minor, std::uint32_t n) {
    TriangleMesh mesh;
    for (std::uint32_t a = 0; a < n; ++a)
        for (std::uint32_t b = 0; b < n; ++b) {
            const double s = 2 * std::numbers::pi * a / n, t = 2 * std::numbers::pi * b / n;
            const Vec3 normal{std::cos(t) * std::cos(s), std::cos(t) * std::sin(s), std::sin(t)};
            mesh.points.push_back(center + Vec3{major * std::cos(s), major * std::sin(s), 0} + minor * normal);
            mesh.normals.push_back(normal);
        }
    for (std::uint32_t a = 0; a < n; ++a)
        for (std::uint32_t b = 0; b < n; ++b) {
            const std::uint32_t a1 = (a + 1) % n, b1 = (b + 1) % n;
            mesh.triangles.push_back({a * n + b, a1 * n + b, a1 * n + b1});
            mesh.triangles.push_back({a * n + b, a1 * n + b1, a * n + b1});
        }
    return mesh;
}

}  // namespace kontur::test
