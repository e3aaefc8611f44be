// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"

namespace kontur {

struct BoxedMask;

/// The surfaces of several objects as one mesh: where two of them touch they have their points and triangles in common.
struct SharedSurface {
    TriangleMesh mesh;  ///< without normals; triangles run counter-clockwise seen from their front
    std::vector<std::vector<std::size_t>> regions;    ///< to which objects each belongs; region 0: to none
    std::vector<std::array<std::uint32_t, 2>> sides;  ///< for each triangle the regions behind it and in front of it
};

/// Surfaces of objects of one grid, which may lie in each other and overlap. Their voxels decide what belongs together;
/// points lie where the objects' depths f / |grad f| say between two voxels: where one object ends, at depth 0, and where
/// two touch, where both depths are equal. One point for each cube of eight voxel centres that are not all of one region:
/// the mean of the crossings on its edges (surface nets, Gibson 1998), moved to f = 0 by one step where one object alone
/// ends. The surface closes half a voxel beyond the grid. The triangles of each object alone (surface_of) are closed; edges
/// at which its voxels meet by an edge only have four. `functions` are those of the objects, in their order. The same for
/// any number of threads.
SharedSurface shared_surface(std::span<const BoxedMask> objects, std::span<const ImplicitFunction> functions,
                             const Grid& grid, const Work& work = {});

/// The surface of one object, with the points that it uses, turned outward.
TriangleMesh surface_of(const SharedSurface& surface, std::size_t object);

}  // namespace kontur
