// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/derive/derive.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A structure that rules may name, as a screen shows it.
struct ShownStructure {
    std::string name;
    std::shared_ptr<const TriangleMesh> mesh;    ///< closed, with at least one triangle
    std::optional<ImplicitFunction> function{};  ///< that the mesh is the surface of, if there is one
};

struct DerivedSurfacesOptions {
    Grid grid;                     ///< of the image
    std::int64_t most_voxels = 0;  ///< that are looked at, larger ones where the image has more; 0: the image's own
    FindBody body{};               ///< on the grid; not needed where no rule asks for it
};

/// The surfaces of what rules make, in their order, for screens: as `derive` makes masks, of the part of the image that the
/// rules can reach, from surfaces in place of masks. Closed, with normals; without triangles where nothing is left. Throws
/// as `derive` does.
std::vector<TriangleMesh> derived_surfaces(std::span<const std::string> rules, std::span<const ShownStructure> structures,
                                           const DerivedSurfacesOptions& options, const Work& work = {});

}  // namespace kontur
