// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// An indexed triangle surface. Triangles run counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> points;   ///< mm, LPS
    std::vector<Vec3> normals;  ///< one unit vector per point, outward; empty when unknown
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws Error(invalid_input) for a point that is not finite or beyond what `float` holds, a triangle with a point that the
/// mesh does not have, or normals for other than all points.
void check_mesh(const TriangleMesh& mesh);

/// A unit normal per point, the mean over its triangles by area; (0, 0, 0) for points in no triangle.
std::vector<Vec3> point_normals(const TriangleMesh& mesh);

/// Enclosed volume in mm^3 (divergence theorem); negative when the triangles are turned inward. This and the following
/// throw Error(invalid_input) for a triangle with a point that the mesh does not have; other points do not matter.
double signed_volume_mm3(const TriangleMesh& mesh);

/// What makes a mesh a solid's surface.
struct MeshTopology {
    bool closed = false;     ///< every edge belongs to two triangles
    bool oriented = false;   ///< ... which run through it in opposite directions
    std::int64_t euler = 0;  ///< points - edges + triangles, over the points in use
    std::int64_t components = 0;
};
MeshTopology topology(const TriangleMesh& mesh);

}  // namespace kontur
