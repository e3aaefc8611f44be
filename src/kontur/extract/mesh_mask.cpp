// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/mesh_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur {
namespace {

/// The first index at or behind a coordinate, at least 0, at most `count`.
std::int64_t first_index(double coordinate, std::int64_t count) {
    return static_cast<std::int64_t>(std::clamp(std::ceil(coordinate), 0.0, static_cast<double>(count)));
}

/// Where the edge between two points meets the plane of an index. Both triangles of the edge get the same point.
Vec3 at_index(Vec3 a, Vec3 b, int axis, double index) {
    const auto comes_first = [](const Vec3& p, const Vec3& q) {
        return std::array{p.x, p.y, p.z} < std::array{q.x, q.y, q.z};
    };
    if (comes_first(b, a)) std::swap(a, b);
    return a + (index - a[axis]) / (b[axis] - a[axis]) * (b - a);
}

/// Rows of voxels along i, with the places where a surface crosses them. A point on a row's plane counts as beyond it.
class Rows {
public:
    explicit Rows(const Index3& size) : size_(size), crossings_(static_cast<std::size_t>(size.j * size.k)) {}

    void add(const std::array<Vec3, 3>& triangle) {
        const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
        for (std::int64_t k = first_index(low, size_.k); k < size_.k && static_cast<double>(k) <= high; ++k) {
            std::array<Vec3, 2> ends{};
            std::size_t count = 0;
            for (std::size_t n = 0; n < 3; ++n) {
                const Vec3 &a = triangle[n], &b = triangle[(n + 1) % 3];
                const auto plane = static_cast<double>(k);
                if ((a.z >= plane) != (b.z >= plane) && count < 2) ends[count++] = at_index(a, b, 2, plane);
            }
            if (count == 2) add_segment(ends[0], ends[1], k);
        }
    }

    /// The number of rows that end inside.
    std::int64_t fill(Mask& mask) {
        std::int64_t open = 0;
        for (std::int64_t k = 0; k < size_.k; ++k)
            for (std::int64_t j = 0; j < size_.j; ++j) {
                std::vector<double>& places = row(j, k);
                std::ranges::sort(places);
                open += static_cast<std::int64_t>(places.size() % 2);
                for (std::size_t n = 1; n < places.size(); n += 2)
                    for (std::int64_t i = first_index(places[n - 1], size_.i); i < first_index(places[n], size_.i); ++i)
                        mask.values[mask.grid.offset(i, j, k)] = 1;
            }
        return open;
    }

private:
    std::vector<double>& row(std::int64_t j, std::int64_t k) {
        return crossings_[static_cast<std::size_t>(j + size_.j * k)];
    }

    void add_segment(const Vec3& a, const Vec3& b, std::int64_t k) {
        const auto [low, high] = std::minmax(a.y, b.y);
        for (std::int64_t j = first_index(low, size_.j); j < size_.j && static_cast<double>(j) <= high; ++j) {
            const auto line = static_cast<double>(j);
            if ((a.y >= line) != (b.y >= line)) row(j, k).push_back(at_index(a, b, 1, line).x);
        }
    }

    Index3 size_;
    std::vector<std::vector<double>> crossings_;
};

bool reaches_beyond(const std::vector<Vec3>& indices, const Index3& size) {
    return std::ranges::any_of(indices, [&](const Vec3& p) {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < -0.5 || p[axis] > static_cast<double>(size[axis]) - 0.5) return true;
        return false;
    });
}

}  // namespace

MeshMask voxelize_mesh(const TriangleMesh& mesh, const Grid& grid, const Work& work) {
    check_mesh(mesh);
    check_grid(grid);
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    std::vector<Vec3> indices;
    for (const Vec3& p : mesh.points) indices.push_back(mm_to_index.apply(p));
    Rows rows(grid.size);
    for (const auto& corners : mesh.triangles) {
        rows.add({indices[corners[0]], indices[corners[1]], indices[corners[2]]});
    }
    work.check();
    MeshMask result{{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))},
                    reaches_beyond(indices, grid.size)};
    if (const std::int64_t open = rows.fill(result.mask); open > 0)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the surface is not closed: {} of voxels end inside of it", counted(open, "row")));
    return result;
}

}  // namespace kontur
