// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/vtk_contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "kontur/io/contours.h"
#include "kontur/io/meshes/mesh.h"
#include "support/bodies.h"
#include "support/damage.h"
#include "support/expect_error.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

const std::vector<Vec3> kPentagon{{0, 0, 1}, {10, 0, 1}, {12, 6, 1}, {5, 9.5, 1}, {-1, 5, 1}};
const std::vector<Vec3> kOpen{{1, 1, 7}, {2, 3, 7}, {5, 3.25, 7}};

class VtkContoursTest : public testing::Test {
protected:
    void make() {
        const auto made = test::run_python("make_vtk.py", {folder_.path().string()});
        ASSERT_EQ(made.exit_code, 0) << made.output;
    }
    fs::path text(const std::string& name, const std::string& content) {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    /// Of lines in text on these points.
    fs::path lines(const std::string& points, const std::string& cells) {
        return text("a.vtk",
                    "# vtk DataFile Version 3.0\nSPACE=LPS\nASCII\nDATASET POLYDATA\n" + points + "\n" + cells + "\n");
    }

    test::TemporaryFolder folder_;
};

TEST_F(VtkContoursTest, ReadsEachWayToStoreThem) {
    make();
    int files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
        SCOPED_TRACE(entry.path());
        const ReadContours read = read_contours(entry.path());
        const std::vector<Contour>& contours = read.contours.contours;
        ASSERT_EQ(contours.size(), 3u);
        EXPECT_EQ(contours[0].points, kPentagon);
        EXPECT_TRUE(contours[0].closed);
        EXPECT_EQ(contours[1].points.size(), 4u) << "edges that meet are one contour";
        EXPECT_TRUE(contours[1].closed);
        EXPECT_NEAR(std::abs(dot(contours[1].plane.normal, Vec3{0, 0, 1})), 1, 1e-12);
        EXPECT_EQ(contours[2].points, kOpen);
        EXPECT_FALSE(contours[2].closed);
        const bool unsaid = entry.path().stem() == "unsaid";
        ASSERT_EQ(read.notes.size(), unsaid ? 2u : 1u) << "a frame that is only presumed is told";
        EXPECT_EQ(read.notes.back(), "1 line does not come back to its start; read as stretches of the object's boundary");
        ++files;
    }
    EXPECT_EQ(files, 19);
}

TEST_F(VtkContoursTest, EndsCleanlyOnEveryDamagedFile) {
    make();
    for (const char* name : {"binary.vtk", "text5.vtk", "packed.vtp", "raw_packed.vtp", "ascii.vtp"}) {
        const std::string bytes = test::read_bytes(folder_ / name);
        const fs::path path = folder_ / ("damaged" + fs::path(name).extension().string());
        int refused = 0;
        const auto read_damaged = [&](const std::string& damaged) {
            test::write_bytes(path, damaged);
            try {
                read_contours(path);
            } catch (const Error& error) {
                ++refused;
            }
        };
        test::for_each_mutant(bytes, 400, 7, read_damaged);
        EXPECT_GT(refused, 20) << name;
    }
}

TEST_F(VtkContoursTest, APrefixIsRefusedAsLongAsItLacksALine) {
    make();
    const std::string vtk = test::read_bytes(folder_ / "binary.vtk"), vtp = test::read_bytes(folder_ / "raw.vtp");
    for (std::size_t length = 0; length < vtk.find("\nPOINT_DATA") - 1; ++length)
        EXPECT_THROW(read_contours(text("part.vtk", vtk.substr(0, length))), Error) << length;
    for (std::size_t length = 0; length < vtp.size() - 1; ++length)
        EXPECT_THROW(read_contours(text("part.vtp", vtp.substr(0, length))), Error) << length;
}

TEST_F(VtkContoursTest, LyingCountsAreRefusedBeforeAllocation) {
    for (const char* binary : {"ASCII", "BINARY"}) {
        const std::string head = std::string("# vtk DataFile Version 3.0\nx\n") + binary + "\nDATASET POLYDATA\n";
        for (const char* part : {"POINTS 4000000000 double\n0 0 0\n", "POINTS 9000000000000000000 float\n",
                                 "POINTS -1 float\n", "POINTS 0 float\nLINES 4000000000 8000000000\n",
                                 "POINTS 0 float\nLINES 1 1\n9\n", "FIELD f 1\na 4000000000 4000000000 float\n"})
            EXPECT_THROW(read_contours(text("a.vtk", head + part)), Error) << part;
    }
    const auto vtp = [&](const std::string& attributes, const std::string& inside) {
        return text("a.vtp", "<VTKFile type=\"PolyData\" " + attributes +
                                 "><PolyData><Piece NumberOfPoints=\"2\" NumberOfLines=\"1\">" + inside +
                                 "</Piece></PolyData></VTKFile>");
    };
    const std::string array = "<Points><DataArray type=\"Float64\" format=\"binary\">";
    EXPECT_KONTUR_ERROR(read_contours(vtp("", array + "////fwAAAAA=</DataArray></Points>")), ErrorKind::corrupt_file,
                        "2147483647");
    EXPECT_KONTUR_ERROR(
        read_contours(vtp("compressor=\"vtkZLibDataCompressor\"", array + "////f////38AAAAA</DataArray></Points>")),
        ErrorKind::corrupt_file, "2147483647 compressed blocks");
    EXPECT_KONTUR_ERROR(read_contours(vtp("compressor=\"vtkLZ4DataCompressor\"", "")), ErrorKind::unsupported,
                        "vtkLZ4DataCompressor");
    EXPECT_KONTUR_ERROR(read_contours(vtp("", "")), ErrorKind::corrupt_file, "2 points are declared");
}

TEST_F(VtkContoursTest, PolygonsThatShareNoEdgeAreContoursAndASurfaceIsNone) {
    const std::string points = "POINTS 6 float\n0 0 0 4 0 0 0 4 0 0 0 5 4 0 5 0 4 5";
    const ReadContours apart = read_contours(lines(points, "POLYGONS 2 8\n3 0 1 2 3 3 4 5"));
    ASSERT_EQ(apart.contours.contours.size(), 2u);
    EXPECT_TRUE(apart.contours.contours[1].closed);
    EXPECT_KONTUR_ERROR(read_contours(lines(points, "POLYGONS 2 8\n3 0 1 2 3 1 0 3")), ErrorKind::unsupported,
                        "a surface of 2 polygons and no lines");
    write_mesh(folder_ / "ball.vtp", test::ball({}, 10, 1));
    EXPECT_KONTUR_ERROR(read_contours(folder_ / "ball.vtp"), ErrorKind::unsupported, "a surface of");
    EXPECT_FALSE(has_vtk_lines(folder_ / "ball.vtp"));
    EXPECT_KONTUR_ERROR(read_mesh(lines(points, "LINES 1 3\n2 0 1")), ErrorKind::unsupported, "1 lines and no polygons");
    EXPECT_TRUE(has_vtk_lines(folder_ / "a.vtk"));
}

TEST_F(VtkContoursTest, StripsBecomeTrianglesOfOneSide) {
    const TriangleMesh mesh = read_mesh(lines("POINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0", "TRIANGLE_STRIPS 1 5\n4 0 1 2 3"));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}}));
}

TEST_F(VtkContoursTest, NamesWhatIsWrong) {
    const std::string points = "POINTS 5 float\n0 0 0 4 0 0 4 4 0 0 4 1 9 9 9";
    EXPECT_KONTUR_ERROR(read_contours(lines(points, "LINES 1 6\n5 0 1 2 3 0")), ErrorKind::invalid_input,
                        "contour 1: is not planar: points lie up to");
    EXPECT_KONTUR_ERROR(read_contours(lines(points, "LINES 1 3\n2 0 5")), ErrorKind::corrupt_file,
                        "refers to point 5, counted from 0, of 5");
    EXPECT_KONTUR_ERROR(read_contours(lines(points, "VERTICES 1 2\n1 0")), ErrorKind::invalid_input, "no lines");
    EXPECT_KONTUR_ERROR(read_contours(lines(points, "")), ErrorKind::corrupt_file, "ends behind its points");
    EXPECT_KONTUR_ERROR(
        read_contours(text("b.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n")),
        ErrorKind::unsupported, "STRUCTURED_POINTS");
    EXPECT_KONTUR_ERROR(read_contours(lines("POINTS 1 long\n0 0 0", "")), ErrorKind::unsupported, "type \"long\"");
}

}  // namespace
}  // namespace kontur
