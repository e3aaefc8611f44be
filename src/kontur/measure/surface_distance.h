// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/shape/mesh.h"

namespace kontur {

/// How far each of these points lies from a closed surface with normals, in mm, at most 2 % too far; negative inside. None
/// for a surface without triangles. Triangles are searched by a tree of boxes, so a point costs about the logarithm of their
/// number.
std::vector<double> distances_mm(std::span<const Vec3> points, const TriangleMesh& surface);

/// The surface's places nearest to these points. None for a surface without triangles. From the middle of a ball, where all
/// places are as near, each triangle is looked at.
std::vector<Vec3> nearest_places(std::span<const Vec3> points, const TriangleMesh& surface);

}  // namespace kontur
