// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/depth_buffer.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr int kBandRows = 64;

/// A mesh point on the screen.
struct ScreenPoint {
    double x, y, depth_mm;
    Vec3 normal;  ///< right, up, towards the viewer
};

std::vector<ScreenPoint> project(const TriangleMesh& mesh, const Camera& camera) {
    const std::vector<Vec3> computed = mesh.normals.empty() ? point_normals(mesh) : std::vector<Vec3>{};
    const std::vector<Vec3>& normals = mesh.normals.empty() ? computed : mesh.normals;
    std::vector<ScreenPoint> result(mesh.points.size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const Vec3 p = camera.project(mesh.points[i]), &n = normals[i];
        result[i] = {p.x, p.y, p.z, {dot(n, camera.plane.u), -dot(n, camera.plane.v), -dot(n, camera.plane.normal)}};
    }
    return result;
}

/// First and last of the pixels whose centres may lie between two coordinates, within [0, size).
std::array<int, 2> pixel_range(double low, double high, int size) {
    const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(size));
    const double last = std::clamp(std::floor(high - 0.5), -1.0, static_cast<double>(size - 1));
    return {static_cast<int>(first), static_cast<int>(last)};
}

/// Twice the triangle's area on the screen, with the sign of its turn.
double signed_area(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct ScreenTriangle {
    const ScreenPoint &a, &b, &c;
};

/// Fills one triangle at a time, clipped to a band of rows.
class BandFiller {
public:
    BandFiller(DepthBuffer& buffer, int first_row, int last_row)
        : buffer_(buffer), first_row_(first_row), last_row_(last_row) {}

    void fill(const ScreenTriangle& triangle) const {
        const auto& [a, b, c] = triangle;
        const double area = signed_area(a, b, c);
        const auto [x0, x1] = pixel_range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), buffer_.width);
        const auto [y0, y1] = pixel_range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), buffer_.height);
        // A hair more than the triangle, so that rounding leaves no gap between neighbours.
        constexpr double kOutside = -1e-9;
        for (int y = std::max(y0, first_row_); y <= std::min(y1, last_row_); ++y)
            for (int x = x0; x <= x1; ++x) {
                const double px = x + 0.5, py = y + 0.5;
                const double wb = ((px - a.x) * (c.y - a.y) - (py - a.y) * (c.x - a.x)) / area;
                const double wc = ((b.x - a.x) * (py - a.y) - (b.y - a.y) * (px - a.x)) / area;
                const double wa = 1 - wb - wc;
                if (wa >= kOutside && wb >= kOutside && wc >= kOutside) offer(x, y, triangle, {wa, wb, wc});
            }
    }

private:
    void offer(int x, int y, const ScreenTriangle& triangle, const Vec3& weight) const {
        const auto& [a, b, c] = triangle;
        auto& pixel =
            buffer_
                .pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(buffer_.width) + static_cast<std::size_t>(x)];
        const auto depth = static_cast<float>(weight.x * a.depth_mm + weight.y * b.depth_mm + weight.z * c.depth_mm);
        if (!(depth > pixel.depth_mm)) return;
        Vec3 n = normalized(weight.x * a.normal + weight.y * b.normal + weight.z * c.normal);
        if (n.z < 0) n = -n;
        pixel = {depth, {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)}};
    }

    DepthBuffer& buffer_;
    int first_row_, last_row_;
};

/// Indices of the triangles that touch each band of rows, in the mesh's order: what makes ties of depth deterministic.
/// Those without an area on the screen, or with one that is not finite, are left out.
std::vector<std::vector<std::uint32_t>> triangles_by_band(const TriangleMesh& mesh, const std::vector<ScreenPoint>& points,
                                                          int height) {
    std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>((height + kBandRows - 1) / kBandRows));
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const double area = signed_area(points[a], points[b], points[c]);
        if (area == 0 || !std::isfinite(area)) continue;
        const auto [first, last] = pixel_range(std::min({points[a].y, points[b].y, points[c].y}),
                                               std::max({points[a].y, points[b].y, points[c].y}), height);
        for (int band = first / kBandRows; band * kBandRows <= last; ++band) bands[band].push_back(t);
    }
    return bands;
}

}  // namespace

DepthBuffer render_depth(const TriangleMesh& mesh, const Camera& camera, const Work& work) {
    DepthBuffer buffer{camera.width, camera.height, {}};
    buffer.pixels.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
    const std::vector<ScreenPoint> points = project(mesh, camera);
    const auto bands = triangles_by_band(mesh, points, camera.height);
    parallel_for(static_cast<std::int64_t>(bands.size()), 1, work, [&](std::int64_t band, std::int64_t) {
        const int first_row = static_cast<int>(band) * kBandRows;
        const BandFiller filler(buffer, first_row, std::min(first_row + kBandRows, camera.height) - 1);
        for (const std::uint32_t t : bands[static_cast<std::size_t>(band)]) {
            const auto& [a, b, c] = mesh.triangles[t];
            filler.fill({points[a], points[b], points[c]});
        }
    });
    return buffer;
}

}  // namespace kontur
