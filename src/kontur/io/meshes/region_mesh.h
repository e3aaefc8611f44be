// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kontur/shape/mesh.h"
#include "kontur/shape/provenance.h"

namespace kontur {

/// What lies on the two sides of each triangle of a mesh.
struct MeshRegions {
    std::vector<std::string> names;                   ///< of all regions; the first one is outside of everything
    std::vector<std::array<std::uint32_t, 2>> sides;  ///< for each triangle the regions behind it and in front of it
};

/// Writes a .ply (binary little endian, LPS mm, 64-bit coordinates) whose faces have the properties `behind` and `front`,
/// the numbers of the regions on either side; comments name the regions ("comment kontur region 2: Liver"). Whole or not at
/// all. Throws Error(unsupported) for another extension; Error(invalid_input) as check_mesh does, for other than one pair
/// for each triangle and for regions without a name; Error(io).
void write_region_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshRegions& regions,
                       const Provenance& provenance = {});

}  // namespace kontur
