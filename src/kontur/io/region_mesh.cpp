// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/region_mesh.h"

#include <fmt/format.h>

#include <bit>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/atomic_file.h"
#include "kontur/io/text_header.h"

namespace kontur {
namespace {

template <class Number>
void append(std::string& bytes, Number value) {
    const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    bytes.append(raw.data(), raw.size());
}

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

std::string header_of(const TriangleMesh& mesh, const MeshRegions& regions, const Provenance& provenance) {
    std::string comments;
    for (const auto& [name, value] : provenance) comments += fmt::format("comment kontur {}: {}\n", name, value);
    for (std::size_t n = 0; n < regions.names.size(); ++n)
        comments += fmt::format("comment kontur region {}: {}\n", n, printable_utf8(regions.names[n]));
    return fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment kontur\ncomment SPACE=LPS\ncomment UNIT=mm\n{}element vertex {}\n"
        "property double x\nproperty double y\nproperty double z\nelement face {}\nproperty list uchar uint vertex_indices\n"
        "property uint behind\nproperty uint front\nend_header\n",
        comments, mesh.points.size(), mesh.triangles.size());
}

}  // namespace

void write_region_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, const MeshRegions& regions,
                       const Provenance& provenance) {
    static_assert(std::endian::native == std::endian::little);
    if (lower_case(path.extension().string()) != ".ply")
        throw Error(ErrorKind::unsupported, fmt::format("{}: only a .ply has room for regions", path.string()));
    check(mesh, regions);
    write_file_atomically(path, [&](AtomicFile& file) {
        file.write(header_of(mesh, regions, provenance));
        for (const Vec3& p : mesh.points) {
            std::string row;
            for (int axis = 0; axis < 3; ++axis) append(row, p[axis]);
            file.write(row);
        }
        for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
            std::string row(1, '\3');
            for (const std::uint32_t corner : mesh.triangles[n]) append(row, corner);
            for (const std::uint32_t region : regions.sides[n]) append(row, region);
            file.write(row);
        }
    });
}

}  // namespace kontur
