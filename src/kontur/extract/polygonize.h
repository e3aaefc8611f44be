// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/extract/track.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// The surface as triangles, from the lattice values already known: closed, oriented outward, manifold; it closes half a
/// voxel beyond the outermost voxel centres where the object leaves the grid. Points lie on lattice edges where the
/// linear interpolant of f vanishes; normals are the function's downhill gradient, evaluated once per point, and on the
/// faces where the grid's border cuts the object off those of the border.
TriangleMesh polygonize(const SurfaceLattice& surface, const ImplicitFunction& function, int threads = 0,
                        const Progress& progress = {});

}  // namespace kontur
