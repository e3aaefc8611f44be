// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/meshes/region_mesh.h"

#include <gtest/gtest.h>

#include <fstream>

#include "kontur/io/meshes/mesh.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

const TriangleMesh kMesh{{{0, 0, 0}, {1.5, 0, 0}, {0, 2.25, 0}, {0, 0, 3}}, {}, {{0, 2, 1}, {0, 1, 3}}};
const MeshRegions kRegions{{"outside", "Liver\nand more", "Kidney"}, {{1, 0}, {2, 1}}};

TEST(RegionMesh, AnyReaderOfPlyGetsTheWhole) {
    const test::TemporaryFolder folder;
    write_region_mesh(folder / "a.PLY", kMesh, kRegions, {{"made", "by hand"}});
    const TriangleMesh mesh = read_mesh(folder / "a.PLY");
    EXPECT_EQ(mesh.points, kMesh.points);
    EXPECT_EQ(mesh.triangles, kMesh.triangles);
}

TEST(RegionMesh, NamesStayOnTheirLines) {
    const test::TemporaryFolder folder;
    write_region_mesh(folder / "a.ply", kMesh, kRegions);
    std::ifstream file(folder / "a.ply", std::ios::binary);
    int comments = 0;
    for (std::string line; std::getline(file, line) && line != "end_header";)
        comments += line.starts_with("comment kontur region ");
    EXPECT_EQ(comments, 3);
    EXPECT_TRUE(file.good());
}

TEST(RegionMesh, RefusesWhatDoesNotFitTogether) {
    const test::TemporaryFolder folder;
    EXPECT_KONTUR_ERROR(write_region_mesh(folder / "a.stl", kMesh, kRegions), ErrorKind::unsupported,
                        "only a .ply has room for regions");
    EXPECT_KONTUR_ERROR(write_region_mesh(folder / "a.ply", kMesh, {kRegions.names, {{1, 0}}}), ErrorKind::invalid_input,
                        "there are 1 pairs of regions for the 2 triangles");
    EXPECT_KONTUR_ERROR(write_region_mesh(folder / "a.ply", kMesh, {kRegions.names, {{1, 0}, {3, 0}}}),
                        ErrorKind::invalid_input, "borders on region 3, counted from 0, of 3");
    EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

}  // namespace
}  // namespace kontur
