// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"

namespace kontur {

struct PreviewOptions {
    double spacing_mm = 2;  ///< of the lattice on which the surface is found, > 0; finer ones show more and cost its square
    Vec3 anchor_mm{};       ///< where one of the lattice's points lies: those of a box move with it
};

/// The surface through `starts` (mm; points on contours) on a lattice of its own, whatever grid a mask would have: closed,
/// oriented outward, manifold, with outward unit normals. Details thinner than the spacing may be missing. Surface that runs
/// farther from the starts' box than half of its diagonal is cut off and closed there. No finite start: no surface. The same
/// bytes for any number of threads. Throws Error(invalid_input) when the spacing is not > 0 and Error(too_large) when it is
/// less than about 1 / 1500 of the starts' extent.
TriangleMesh preview_surface(const ImplicitFunction& function, std::span<const Vec3> starts,
                             const PreviewOptions& options = {}, const Work& work = {});

/// A mesh, and the lattice on which its surface was found.
struct LatticeSurface {
    TriangleMesh mesh;
    SurfaceLattice lattice;
};

/// preview_surface with its lattice; nullopt without a finite start.
std::optional<LatticeSurface> preview_with_lattice(const ImplicitFunction& function, std::span<const Vec3> starts,
                                                   const PreviewOptions& options = {}, const Work& work = {});

/// The lattice that preview_surface finds the surface on, its points at multiples of the spacing from the anchor; nullopt
/// without a finite start. Throws as preview_surface does.
std::optional<Grid> preview_lattice(std::span<const Vec3> starts, double spacing_mm, const Vec3& anchor_mm = {});

}  // namespace kontur
