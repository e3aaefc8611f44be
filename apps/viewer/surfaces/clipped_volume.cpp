// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/clipped_volume.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace kontur::viewer {
namespace {

using Polygon = std::vector<Vec3>;

/// The part of the polygon where `sign * p[axis] <= sign * limit`.
Polygon clipped(const Polygon& polygon, int axis, double limit, double sign) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
        if (da <= 0) part.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) part.push_back(a + da / (da - db) * (b - a));
    }
    return part;
}

/// Integral of x over the polygon's projection along x, counted with its orientation.
double prism(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec3 &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
        const double area = ((b.y - a.y) * (c.z - a.z) - (c.y - a.y) * (b.z - a.z)) / 2;
        sum += area * (a.x + b.x + c.x) / 3;
    }
    return sum;
}

Polygon flattened(Polygon polygon, double x) {
    for (Vec3& p : polygon) p.x = x;
    return polygon;
}

}  // namespace

// By the divergence theorem, of the field (x limited to the box, 0, 0): the faces that close the cut across y and z add
// nothing, so that they need not be made.
double volume_within_mm3(const TriangleMesh& mesh, const Grid& image) {
    const Affine3 to_index = image.index_to_mm.inverse();
    const Vec3 low{-0.5, -0.5, -0.5};
    const Vec3 high{static_cast<double>(image.size.i) - 0.5, static_cast<double>(image.size.j) - 0.5,
                    static_cast<double>(image.size.k) - 0.5};
    double volume = 0;
    for (const auto& triangle : mesh.triangles) {
        Polygon polygon;
        for (const auto corner : triangle) polygon.push_back(to_index.apply(mesh.points[corner]));
        for (const int axis : {1, 2}) {
            polygon = clipped(polygon, axis, high[axis], 1);
            polygon = clipped(polygon, axis, low[axis], -1);
        }
        volume += prism(flattened(clipped(polygon, 0, low.x, 1), low.x));
        volume += prism(clipped(clipped(polygon, 0, low.x, -1), 0, high.x, 1));
        volume += prism(flattened(clipped(polygon, 0, high.x, -1), high.x));
    }
    const double voxel_mm3 =
        dot(image.index_to_mm.column(0), cross(image.index_to_mm.column(1), image.index_to_mm.column(2)));
    return volume * voxel_mm3;  // of a left-handed grid both are negative
}

}  // namespace kontur::viewer
