// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// The surface of level 0 on the lattice, closed, with normals; without triangles where nothing is inside.
TriangleMesh level_mesh(const Levels& levels, const Grid& lattice, const Work& work);

}  // namespace kontur
