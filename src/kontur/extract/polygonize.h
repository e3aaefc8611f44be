// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/function/fast_function.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// The surface as triangles, from the lattice values already known and some two more for each point: closed, oriented
/// outward, manifold; it closes half a voxel beyond the outermost voxel centres where the object leaves the grid. Points lie
/// on lattice edges where f vanishes, within a fiftieth of the smallest spacing; normals are the function's downhill
/// gradient within 0.01, and on the faces where the grid's border cuts the object off those of the border.
TriangleMesh polygonize(const SurfaceLattice& surface, const ImplicitFunction& function, const Work& work = {});

/// How near to where f vanishes points come, and to its gradient normals.
enum class MeshAccuracy {
    of_a_file,    ///< as said above
    of_a_screen,  ///< from the lattice's values alone where they are straight: 99 of 100 points within a tenth of the
                  ///< spacing (half of them within a three-hundredth), and 99 of 100 normals within six degrees
};

/// The same with a function that may have been prepared for the surface by evaluating it there.
TriangleMesh polygonize(const SurfaceLattice& surface, FastFunction& function, const Work& work = {},
                        MeshAccuracy accuracy = MeshAccuracy::of_a_file);

/// The same from the lattice's values alone, for a function that is not there to be evaluated. Where values bend, points
/// are where linear interpolation puts them.
TriangleMesh polygonize(const SurfaceLattice& surface);

}  // namespace kontur
