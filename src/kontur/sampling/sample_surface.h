// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/function/implicit_function.h"
#include "kontur/sampling/surface_samples.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// Few are enough: all that is made of them are means over the surface and which planes are near.
inline constexpr std::size_t kSurfaceSamples = 1200;

/// Some of the places where the surface crosses lattice edges, chosen at equal steps in the order of the cells, moved onto
/// the surface by one step of Newton. A crossing stands for the area that crosses as many edges on average (Crofton), so
/// that no mesh is needed. Where the grid's border cuts the object off there is none. `most` evaluations of f and its
/// gradient. The samples move with the grid and do not depend on `threads`.
SurfaceSamples sample_surface(const SurfaceLattice& surface, const ImplicitFunction& function,
                              std::size_t most = kSurfaceSamples, const Work& work = {});

/// Points on the triangles at equal steps of area, in their order.
SurfaceSamples sample_surface(const TriangleMesh& mesh, const ImplicitFunction& function, std::size_t most = kSurfaceSamples,
                              const Work& work = {});

}  // namespace kontur
