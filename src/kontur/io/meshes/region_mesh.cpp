// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/meshes/region_mesh.h"

#include <fmt/format.h>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/meshes/mesh_formats.h"

namespace kontur {
namespace {

void check(const TriangleMesh& mesh, const MeshRegions& regions) {
    check_mesh(mesh);
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); };
    if (regions.sides.size() != mesh.triangles.size())
        refuse(fmt::format("there are {} pairs of regions for the {} triangles of the mesh", regions.sides.size(),
                           mesh.triangles.size()));
    for (const auto& sides : regions.sides)
        for (const std::uint32_t region : sides)
            if (region >= regions.names.size())
                refuse(fmt::format("a triangle borders on region {}, counted from 0, of {}", region, regions.names.size()));
}

}  // namespace

void write_region_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshRegions& regions,
                       const Provenance& provenance) {
    if (lower_case(path.extension().string()) != ".ply")
        throw Error(ErrorKind::unsupported, fmt::format("{}: only a .ply has room for regions", path.string()));
    check(mesh, regions);
    write_file_atomically(path, [&](AtomicFile& file) { write_ply(file, mesh, {.regions = &regions}, provenance); });
}

}  // namespace kontur
