// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/meshes/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "support/bodies.h"
#include "support/expect_error.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

using test::TemporaryFolder;

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void save(const std::filesystem::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

TriangleMesh read_text(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
    save(folder / name, text);
    return read_mesh(folder / name);
}

TriangleMesh body() { return test::torus({-123.456789, 45.678912, 1534.987654}, 30, 9, 24); }

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    EXPECT_EQ(a.size(), b.size());
    double largest = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) largest = std::max(largest, distance(a[i], b[i]));
    return largest;
}

TEST(MeshFile, PlyAndVtkKeepPointsNormalsAndTrianglesExactly) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    for (const char* name : {"body.ply", "body.vtk", "body.VTP"}) {
        write_mesh(folder / name, mesh);
        const TriangleMesh read = read_mesh(folder / name);
        EXPECT_EQ(read.points, mesh.points) << name;
        EXPECT_EQ(read.triangles, mesh.triangles) << name;
        EXPECT_LT(largest_distance(read.normals, mesh.normals), 1e-7) << name;
    }
}

TEST(MeshFile, PlyKeepsANumberForEachPoint) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    PointValues widths{"half_width_mm", {}};
    for (std::size_t n = 0; n < mesh.points.size(); ++n) widths.values.push_back(0.25 * static_cast<double>(n));
    write_mesh(folder / "body.ply", mesh, widths);
    EXPECT_EQ(read_mesh(folder / "body.ply").points, mesh.points);
    const std::string bytes = bytes_of(folder / "body.ply");
    EXPECT_NE(bytes.find("property float nz\nproperty float half_width_mm\nelement face"), std::string::npos);
    const std::size_t first = bytes.find("end_header\n") + 11, row = 3 * 8 + 4 * 4;
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, mesh.points.size() - 1}) {
        float value = -1;
        std::memcpy(&value, bytes.data() + first + n * row + row - 4, 4);
        EXPECT_EQ(value, 0.25F * static_cast<float>(n));
    }
    widths.values.pop_back();
    EXPECT_KONTUR_ERROR(write_mesh(folder / "less.ply", mesh, widths), ErrorKind::invalid_input,
                        "half_width_mm has 575 values");
    EXPECT_KONTUR_ERROR(write_mesh(folder / "body.stl", mesh, widths), ErrorKind::unsupported, "only a .ply");
}

TEST(MeshFile, ObjKeepsPointsAndNormalsToItsDecimals) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    write_mesh(folder / "body.obj", mesh);
    const TriangleMesh read = read_mesh(folder / "body.obj");
    EXPECT_LT(largest_distance(read.points, mesh.points), 1e-6);
    EXPECT_LT(largest_distance(read.normals, mesh.normals), 1e-6);
    EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST(MeshFile, StlComesBackAsOneClosedSurfaceInPlace) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    write_mesh(folder / "body.STL", mesh);
    const TriangleMesh read = read_mesh(folder / "body.STL");
    EXPECT_EQ(read.points.size(), mesh.points.size());
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_LT(distance(read.points[read.triangles[t][corner]], mesh.points[mesh.triangles[t][corner]]), 1e-4);
    const MeshTopology shape = topology(read);
    EXPECT_TRUE(shape.closed);
    EXPECT_TRUE(shape.oriented);
    EXPECT_EQ(shape.euler, 0);
}

/// As other programs write it, to the digits that a float needs.
std::string text_stl(const TriangleMesh& mesh, const std::string& title) {
    std::ostringstream text;
    text.precision(9);
    text << "solid " << title << "\r\n";
    for (const auto& triangle : mesh.triangles) {
        text << "  FACET normal 0 0 1\r\n    outer loop\r\n";
        for (const std::uint32_t corner : triangle) {
            const Vec3& p = mesh.points[corner];
            text << "\tvertex " << static_cast<float>(p.x) << " " << static_cast<float>(p.y) << "  "
                 << static_cast<float>(p.z) << "\r\n";
        }
        text << "    endloop\r\n  endfacet\r\n";
    }
    text << "endsolid " << title << "\r\n";
    return text.str();
}

TEST(MeshFile, TextStlIsTheSameMeshAsBinaryStl) {
    const TemporaryFolder folder;
    write_mesh(folder / "binary.stl", body());
    const TriangleMesh binary = read_mesh(folder / "binary.stl"), text = read_text(folder, "t.stl", text_stl(body(), "x"));
    EXPECT_EQ(text.points, binary.points);
    EXPECT_EQ(text.triangles, binary.triangles);
    const TriangleMesh ras = read_text(folder, "r.stl", text_stl(body(), "x SPACE=RAS"));
    EXPECT_EQ(ras.points[3], (Vec3{-text.points[3].x, -text.points[3].y, text.points[3].z}));
    TriangleMesh one = body();
    one.triangles.resize(1);
    const std::string whole = text_stl(one, "x");
    for (std::size_t size = whole.find("endfacet") + 8; size < whole.find("endsolid") + 8; ++size)
        EXPECT_KONTUR_ERROR(read_text(folder, "cut.stl", whole.substr(0, size)), ErrorKind::corrupt_file, "cut.stl");
}

TEST(MeshFile, EmptyMeshAndMeshWithoutNormalsSurvive) {
    const TemporaryFolder folder;
    TriangleMesh bare = body();
    bare.normals.clear();
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
        write_mesh(folder / name, {});
        EXPECT_TRUE(read_mesh(folder / name).points.empty()) << name;
        EXPECT_TRUE(read_mesh(folder / name).triangles.empty()) << name;
        write_mesh(folder / name, bare);
        EXPECT_TRUE(read_mesh(folder / name).normals.empty()) << name;
        EXPECT_EQ(read_mesh(folder / name).triangles.size(), bare.triangles.size()) << name;
    }
}

TEST(MeshFile, SaysThatItIsLps) {
    const TemporaryFolder folder;
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk"}) {
        write_mesh(folder / name, body());
        EXPECT_NE(bytes_of(folder / name).substr(0, 120).find("SPACE=LPS"), std::string::npos) << name;
    }
}

TEST(MeshFile, DeclaredRasIsTurnedAndKeepsItsOutside) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
        write_mesh(folder / name, mesh);
        std::string bytes = bytes_of(folder / name);
        const std::string lps_in_numbers = "76 80 83 0";
        if (const auto at = bytes.find(lps_in_numbers); at < 400) bytes.replace(at, lps_in_numbers.size(), "82 65 83 0");
        for (auto at = bytes.find("SPACE=LPS"); at < 200; at = bytes.find("SPACE=LPS", at))
            bytes.replace(at, 9, "SPACE=RAS");
        save(folder / name, bytes);
        const TriangleMesh read = read_mesh(folder / name);
        const Vec3 p = mesh.points[mesh.triangles[5][1]], q = read.points[read.triangles[5][1]];
        EXPECT_LT(distance(q, {-p.x, -p.y, p.z}), 1e-4) << name;
        EXPECT_NEAR(signed_volume_mm3(read), signed_volume_mm3(mesh), 0.1) << name;
        if (read.normals.empty()) continue;
        const Vec3 n = mesh.normals[7];
        EXPECT_LT(distance(read.normals[7], {-n.x, -n.y, n.z}), 1e-6) << name;
    }
}

TEST(MeshFile, IndependentReaderFindsTheSameTriangles) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = body();
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
        write_mesh(folder / name, mesh);
        const auto python = test::run_python("mesh_volume.py", {folder / name});
        ASSERT_EQ(python.exit_code, 0) << python.output;
        std::istringstream output(python.output);
        std::size_t triangles = 0;
        double volume = 0, worst_normal = 0;
        output >> triangles >> volume >> worst_normal;
        EXPECT_EQ(triangles, mesh.triangles.size()) << name;
        EXPECT_NEAR(volume, signed_volume_mm3(mesh), 1e-5 * volume) << name;
        EXPECT_GT(worst_normal, 0.9) << name << ": normals point out of the triangles";
    }
}

TEST(MeshFile, ReadsTextPlyWithPolygonsAndPropertiesItDoesNotKnow) {
    const TemporaryFolder folder;
    const TriangleMesh mesh =
        read_text(folder, "a.ply",
                  "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 4\r\nproperty uchar red\r\n"
                  "property float x\r\nproperty float y\r\nproperty float z\r\nelement note 2\r\n"
                  "property list uchar float value\r\nelement face 1\r\nproperty list uchar int vertex_index\r\n"
                  "property int flag\r\nend_header\r\n9 0 0 0\r\n9 1 0 0\r\n9 1 1e0 +0\r\n9 0 1 -0.5\r\n2 7 8\r\n0\r\n"
                  "4 0 1 2 3 77\r\n");
    EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, -0.5}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(MeshFile, ReadsBigEndianPlyWithFacesBeforeThePoints) {
    const TemporaryFolder folder;
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement face 1\nproperty list uint8 uint16 vertex_indices\n"
        "element vertex 3\nproperty float x\nproperty short y\nproperty double z\nend_header\n";
    const auto append = [&](auto value) {
        std::array<char, sizeof value> raw;
        std::memcpy(raw.data(), &value, sizeof value);
        std::reverse(raw.begin(), raw.end());
        for (const char byte : raw) bytes.push_back(byte);
    };
    append(std::uint8_t{3});
    for (const int corner : {2, 0, 1}) append(static_cast<std::uint16_t>(corner));
    for (int i = 0; i < 3; ++i) {
        append(1.5f * static_cast<float>(i));
        append(static_cast<std::int16_t>(-i));
        append(300.25);
    }
    const TriangleMesh mesh = read_text(folder, "a.ply", bytes);
    EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 300.25}, {1.5, -1, 300.25}, {3, -2, 300.25}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{2, 0, 1}}));
}

TEST(MeshFile, ReadsObjOfOtherPrograms) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = read_text(folder, "a.obj",
                                        "mtllib x.mtl\nv 0 0 0 1\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvn 0 0 1\ng part\n"
                                        "f 1/1/1 2/1/1 -2/1/1 4//1\n");
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(mesh.normals, std::vector<Vec3>(4, {0, 0, 1}));
    const TriangleMesh creased =
        read_text(folder, "b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//1 2//1\n");
    EXPECT_TRUE(creased.normals.empty());
    EXPECT_EQ(creased.triangles.size(), 2u);
}

TEST(MeshFile, StlMergesEqualPointsOnlyAndDropsCollapsedTriangles) {
    const TemporaryFolder folder;
    // 0 and -0 are the same place; the second triangle is thinner than a float near 1e5 mm can tell.
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {1e5, 0, 0}, {1e5 + 1e-6, 0, 0}, {1, 1e-6, 0}},
                            {},
                            {{0, 1, 2}, {3, 4, 5}, {3, 6, 2}}};
    write_mesh(folder / "a.stl", mesh);
    const TriangleMesh read = read_mesh(folder / "a.stl");
    EXPECT_EQ(read.triangles.size(), 2u);
    EXPECT_EQ(read.triangles[0][0], read.triangles[1][0]);
    EXPECT_NE(read.triangles[0][1], read.triangles[1][1]);
}

TEST(MeshFile, RejectsEveryTruncatedPrefix) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = test::ball({}, 10, 0);
    for (const char* name : {"a.stl", "a.ply", "a.vtk", "a.vtp"}) {
        TriangleMesh written = mesh;
        // VTK's legacy format has no end: a file that is cut off between surface and normals is a file without normals.
        if (std::string_view(name).ends_with(".vtk")) written.normals.clear();
        write_mesh(folder / name, written);
        const std::string whole = bytes_of(folder / name);
        for (std::size_t size = 0; size < whole.size(); ++size) {
            save(folder / name, whole.substr(0, size));
            EXPECT_KONTUR_ERROR(read_mesh(folder / name), ErrorKind::corrupt_file, name);
        }
    }
}

TEST(MeshFile, FlippedBytesGiveAnErrorOrAMeshButNothingWorse) {
    const TemporaryFolder folder;
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
        write_mesh(folder / name, test::ball({}, 10, 0));
        const std::string whole = bytes_of(folder / name);
        for (std::size_t i = 0; i < whole.size(); i += 3) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
            save(folder / name, damaged);
            try {
                const TriangleMesh mesh = read_mesh(folder / name);
                for (const auto& triangle : mesh.triangles)
                    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.points.size());
            } catch (const Error& error) {
                EXPECT_TRUE(error.kind() == ErrorKind::corrupt_file || error.kind() == ErrorKind::unsupported ||
                            error.kind() == ErrorKind::too_large)
                    << error.what();
            }
        }
    }
}

TEST(MeshFile, RefusesLyingCountsBeforeAllocation) {
    const TemporaryFolder folder;
    std::string stl(84, '\0');
    stl.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.stl", stl), ErrorKind::corrupt_file, "4294967295 triangles");
    const auto ply = [](const std::string& coding, const std::string& elements, const std::string& data) {
        return "ply\nformat " + coding + " 1.0\n" + elements + "end_header\n" + data;
    };
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    for (const char* coding : {"ascii", "binary_little_endian"}) {
        EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply(coding, "element vertex 4000000000\n" + xyz, "0 0 0\n")),
                            ErrorKind::corrupt_file, "4000000000 of \"vertex\"");
        EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply(coding, "element dust 9000000000000000000\n", "")),
                            ErrorKind::corrupt_file, "no properties");
        EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply(coding, "element vertex -1\n" + xyz, "")),
                            ErrorKind::corrupt_file, "-1");
    }
    const std::string face = "element face 1\nproperty list uint int vertex_indices\n";
    EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply("binary_little_endian", face, "\xff\xff\xff\x7fxxxx")),
                        ErrorKind::corrupt_file, "a list of 2147483647");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply("ascii", face, "1000000 0 1 2\n")), ErrorKind::corrupt_file,
                        "a list of 1000000");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.ply", ply("ascii", face, "3 0 1 2\n")), ErrorKind::corrupt_file,
                        "refers to point 0");
}

TEST(MeshFile, NamesWhatIsWrongInAText) {
    const TemporaryFolder folder;
    EXPECT_KONTUR_ERROR(read_text(folder, "a.obj", "v 0 0 0\nv 1 x 0\n"), ErrorKind::corrupt_file, "line 2: \"x\"");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.obj", "v 0 0 nan\n"), ErrorKind::corrupt_file, "nan");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.obj", "v 0 0 0\nf 1 1 2\n"), ErrorKind::corrupt_file, "point 2 of 1");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.obj", "v 0 0 0\nf 1 1\n"), ErrorKind::corrupt_file, "2 corners");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.stl", "solid x\n facet normal 0 0 1\n"), ErrorKind::corrupt_file,
                        "amid its triangles");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.stl", "solid x\nfacet\nvertex 0 0 0\nendfacet\nendsolid\n"),
                        ErrorKind::corrupt_file, "line 4: a facet has 1 corners; 3 are needed");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.stl", "solid x\nfacet\nvertex 0 1e99 0\n"), ErrorKind::corrupt_file,
                        "line 3: the coordinate 1e+99 is beyond");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.stl", "solid x\nfacet\nedge 0 1\n"), ErrorKind::corrupt_file,
                        "\"edge\" is no word of STL");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.off", ""), ErrorKind::unsupported, ".off");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.vtk", ""), ErrorKind::corrupt_file, "# vtk DataFile");
    EXPECT_KONTUR_ERROR(read_text(folder, "a.vtp", "<VTKFile type=\"ImageData\"></VTKFile>"), ErrorKind::unsupported,
                        "ImageData");
    EXPECT_KONTUR_ERROR(read_mesh(folder / "missing.stl"), ErrorKind::io, "missing.stl");
}

TEST(MeshFile, RefusesMeshesThatMakeNoSenseAndLeavesNothingBehind) {
    const TemporaryFolder folder;
    for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
        EXPECT_KONTUR_ERROR(write_mesh(folder / name, {{{0, NAN, 0}}, {}, {}}), ErrorKind::invalid_input, "point 1");
        EXPECT_KONTUR_ERROR(write_mesh(folder / name, {{{0, 1e300, 0}}, {}, {}}), ErrorKind::invalid_input, "1e+300");
        EXPECT_KONTUR_ERROR(write_mesh(folder / name, {{{0, 0, 0}}, {}, {{0, 0, 1}}}), ErrorKind::invalid_input,
                            "point 2 of 1");
        EXPECT_KONTUR_ERROR(write_mesh(folder / name, {{{0, 0, 0}}, {{}, {}}, {}}), ErrorKind::invalid_input,
                            "2 normals for 1");
    }
    EXPECT_KONTUR_ERROR(write_mesh(folder / "mesh", {}), ErrorKind::unsupported, "mesh");
    EXPECT_EQ(folder.entry_count(), 0);
}

}  // namespace
}  // namespace kontur
