// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kontur/extract/rasterize.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/geometry/keyhole.h"
#include "support/damage.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3> ring(const Plane& plane, double u, double v, double radius, int points) {
    std::vector<Vec3> result;
    for (int n = 0; n < points; ++n) {
        const double angle = 2 * std::numbers::pi * n / points;
        result.push_back(plane.from_uv(u + radius * std::cos(angle), v + radius * std::sin(angle)));
    }
    return result;
}

class WriteRtstruct : public testing::Test {
protected:
    /// Makes the images "axial" or "oblique" to draw on: 9 slices of 14 x 12 pixels.
    void use_images(const std::string& name) {
        const auto made = test::run_python("make_dicom_series.py", {name, (folder_ / name).string()});
        ASSERT_EQ(made.exit_code, 0) << made.output;
        images_ = folder_ / name / "dicom";
        const DicomGrid found = read_dicom_grid(images_);
        series_ = found.series;
        grid_ = found.grid;
    }

    Plane slice(std::int64_t k) const {
        const Vec3 u = normalized(grid_.index_to_mm.column(0)), v = normalized(grid_.index_to_mm.column(1));
        return {grid_.center_mm(0, 0, k), cross(u, v), u, v};
    }

    void add(ContourSet& set, const Plane& plane, const std::array<double, 2>& at, double radius, int points = 24) const {
        set.contours.push_back({.plane = plane, .points = ring(plane, at[0], at[1], radius, points)});
    }

    static StructureAttributes attributes() {
        return {.color = {{10, 20, 255}},
                .interpreted_type = "GTV",
                .generation_algorithm = "SEMIAUTOMATIC",
                .description = "a\\b, \xC3\xA4 and\na second line",
                .code = {{"10200004", "SCT", "Liver"}},
                .physical_properties = {{"REL_ELEC_DENSITY", 1.25}, {"EFFECTIVE_Z", 7}}};
    }

    /// Slice 2: a disc with two holes, an island in one of them, and another disc; slice 3: a disc.
    Roi holes() const {
        Roi roi;
        roi.name = "L\xC3\xA4sion \xD0\x96";
        roi.contours.attributes = attributes();
        add(roi.contours, slice(2), {4.03, 4.11}, 3.47);
        add(roi.contours, slice(2), {2.53, 4.07}, 1.2);
        add(roi.contours, slice(2), {2.53, 4.07}, 0.5);
        add(roi.contours, slice(2), {5.53, 4.31}, 0.8);
        add(roi.contours, slice(2), {8.51, 6.03}, 0.8);
        add(roi.contours, slice(3), {4.03, 4.11}, 3.03);
        return roi;
    }

    fs::path path() const { return folder_ / "structures.dcm"; }
    std::vector<std::string> write(const Roi& roi, const WriteRtstructOptions& options = {}) const {
        return write_rtstruct(path(), {"test", {roi}}, series_, options);
    }
    /// What others read in the file; a failed test unless they find no fault.
    std::string verdict() const {
        const auto checked = test::run_python("check_rtstruct.py", {path().string(), images_.string()});
        EXPECT_EQ(checked.exit_code, 0) << checked.output;
        return checked.output;
    }

    test::TemporaryFolder folder_;
    fs::path images_;
    DicomSeries series_;
    Grid grid_;
};

int count(const std::string& text, std::string_view part) {
    int found = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

/// Every point of one set is near some point of the other.
double largest_distance(const ContourSet& from, const ContourSet& to) {
    double worst = 0;
    for (const Contour& contour : from.contours)
        for (const Vec3& p : contour.points) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Contour& other : to.contours)
                for (const Vec3& q : other.points) nearest = std::min(nearest, distance(p, q));
            worst = std::max(worst, nearest);
        }
    return worst;
}

TEST_F(WriteRtstruct, ComesBackTheSameWithHolesInEachEncoding) {
    for (const char* images : {"axial", "oblique"}) {
        use_images(images);
        const Roi roi = holes();
        const Mask mask = rasterize(roi.contours, grid_);
        for (const HoleEncoding encoding : {HoleEncoding::keyhole, HoleEncoding::exclusive, HoleEncoding::nested}) {
            SCOPED_TRACE(std::string(images) + ", encoding " + std::to_string(static_cast<int>(encoding)));
            EXPECT_TRUE(write(roi, {.holes = encoding}).empty());
            const StructureSet set = read_rtstruct(path());
            EXPECT_EQ(set.label, "test");
            ASSERT_EQ(set.rois.size(), 1u);
            const Roi& again = set.rois.front();
            EXPECT_EQ(again.name, roi.name);
            EXPECT_EQ(again.number, 1);
            StructureAttributes attributes = roi.contours.attributes;
            attributes.number = 1;
            EXPECT_EQ(again.contours.attributes, attributes);
            EXPECT_EQ(again.frame_of_reference_uid, series_.frame_of_reference_uid);
            EXPECT_EQ(again.contours.contours.size(), 6u);
            EXPECT_EQ(point_count(again.contours), point_count(roi.contours));
            EXPECT_LT(largest_distance(again.contours, roi.contours), 1e-9);
            EXPECT_LT(largest_distance(roi.contours, again.contours), 1e-9);
            EXPECT_EQ(rasterize(again.contours, grid_).values, mask.values);
        }
    }
}

TEST_F(WriteRtstruct, IsUnderstoodByOthers) {
    for (const char* images : {"axial", "oblique", "tilt"}) {
        use_images(images);
        write(holes());
        const std::string seen = verdict();
        EXPECT_NE(seen.find("1 L\xC3\xA4sion \xD0\x96 GTV SEMIAUTOMATIC 10,20,255"), std::string::npos) << seen;
        EXPECT_NE(seen.find("DESCRIPTION a\\b, \xC3\xA4 and\r\na second line\n"), std::string::npos) << seen;
        EXPECT_NE(seen.find("CODE 10200004 SCT Liver\nPROPERTY REL_ELEC_DENSITY 1.25\nPROPERTY EFFECTIVE_Z 7\n"),
                  std::string::npos)
            << seen;
        EXPECT_EQ(count(seen, "CLOSED_PLANAR 76 "), 1) << "the disc with its two holes and two channels: 3 x 24 + 4";
        EXPECT_EQ(count(seen, "CLOSED_PLANAR 24 "), 3) << "the island, the other disc, the next slice";
        EXPECT_EQ(count(seen, " -\n"), 0) << "each names its slice";
    }
}

TEST_F(WriteRtstruct, KeepsLongContours) {
    use_images("axial");
    Roi roi;
    roi.name = "long";
    add(roi.contours, slice(4), {4, 4}, 3, 8000);
    write(roi);
    EXPECT_GT(fs::file_size(path()), 300'000u);
    EXPECT_NE(verdict().find("CLOSED_PLANAR 8000 28.2743"), std::string::npos);
    const Roi again = select_roi(read_rtstruct(path()));
    ASSERT_EQ(point_count(again.contours), 8000u);
    EXPECT_LT(largest_distance(again.contours, roi.contours), 1e-9);
}

TEST_F(WriteRtstruct, SaysWhichContoursLieOnNoSlice) {
    use_images("axial");
    Roi roi = holes();
    add(roi.contours, make_plane(grid_.center_mm(7, 6, 4), {1, 0, 0}), {0, 0}, 3);
    const std::vector<std::string> notes = write(roi);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_TRUE(notes.front().starts_with("1 contour lies on no slice of the images")) << notes.front();
    EXPECT_EQ(count(verdict(), " -\n"), 1);
}

TEST_F(WriteRtstruct, NumbersRoisThatHaveNone) {
    use_images("axial");
    StructureSet set{"", {holes(), holes(), Roi{}}};
    set.rois[0].number = 2;
    set.rois[2].name = std::string(70, 'x') + "\\";
    const std::vector<std::string> notes = write_rtstruct(path(), set, series_);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes.front().find("ROI 3 has 71 characters, of which DICOM has room for 64; it is written as 'xxx"),
              std::string::npos)
        << notes.front();
    const StructureSet again = read_rtstruct(path());
    EXPECT_EQ(again.rois[0].number, 2);
    EXPECT_EQ(again.rois[1].number, 1);
    EXPECT_EQ(again.rois[2].number, 3);
    EXPECT_EQ(again.rois[2].name, std::string(64, 'x')) << "DICOM's limit";
    EXPECT_TRUE(again.rois[2].contours.contours.empty());
    verdict();
    set.rois[1].number = 2;
    EXPECT_KONTUR_ERROR(write_rtstruct(path(), set, series_), ErrorKind::invalid_input, "two ROIs have the number 2");
}

TEST_F(WriteRtstruct, NumbersRoisAsTheirAttributesSayWhereTheNumberIsFree) {
    use_images("axial");
    StructureSet set{"", {holes(), holes(), holes(), holes()}};
    set.rois[0].number = 7;
    for (const std::size_t n : {1u, 2u}) set.rois[n].contours.attributes.number = 1;
    set.rois[3].contours.attributes.number = 7;
    write_rtstruct(path(), set, series_);
    std::vector<std::int64_t> numbers;
    for (const Roi& roi : read_rtstruct(path()).rois) numbers.push_back(roi.number);
    EXPECT_EQ(numbers, (std::vector<std::int64_t>{7, 1, 2, 3}));
    set.rois[0].number = std::int64_t{1} << 31;
    EXPECT_KONTUR_ERROR(write_rtstruct(path(), set, series_), ErrorKind::invalid_input, "a ROI has the number 2147483648");
}

TEST_F(WriteRtstruct, IsApprovedIfAllOfItIsByWhoDidSoLast) {
    use_images("axial");
    StructureSet set{"", {holes(), holes()}};
    const auto review = [&](std::size_t n) -> Review& { return set.rois[n].contours.attributes.review; };
    review(0) = {Approval{"Doe^Jane", "2026-11-30T21:02:43"}, "cropped\nto the body", true};
    std::vector<std::string> notes = write_rtstruct(path(), set, series_);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes.front(), "1 of 2 ROIs is approved; DICOM approves all or none, so the file says UNAPPROVED");
    EXPECT_EQ(verdict().find("APPROVED"), std::string::npos);
    for (const Roi& roi : read_rtstruct(path()).rois) EXPECT_FALSE(roi.contours.attributes.review.approved.has_value());
    EXPECT_EQ(read_rtstruct(path()).rois.front().contours.attributes.review.comment, "cropped\nto the body");

    review(1).approved = Approval{"Roe^Richard", "2026-12-01T08:00:00"};
    notes = write_rtstruct(path(), set, series_);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes.front(),
              "2 people approved the ROIs; DICOM has room for one, and the file names 'Roe^Richard', the last");
    EXPECT_NE(verdict().find("APPROVED by Roe^Richard on 20261201 at 080000"), std::string::npos);
    for (const Roi& roi : read_rtstruct(path()).rois) {
        EXPECT_EQ(roi.contours.attributes.review.approved, review(1).approved);
        EXPECT_FALSE(roi.contours.attributes.review.locked) << "DICOM has no room for it";
    }
}

TEST_F(WriteRtstruct, SaysWhichAttributesDicomHasNoRoomFor) {
    use_images("axial");
    Roi roi = holes();
    StructureAttributes& attributes = roi.contours.attributes;
    attributes.interpreted_type = "Organ";
    attributes.generation_algorithm = "by hand, of course";
    attributes.description = std::string(1025, 'x');
    attributes.code = {{"1", std::string(17, 's'), "no scheme"}};
    attributes.physical_properties = {{"density!", 1}};
    const std::vector<std::string> notes = write(roi);
    ASSERT_EQ(notes.size(), 4u);
    const std::string of_roi = " of ROI 'L\xC3\xA4sion \xD0\x96' ";
    EXPECT_EQ(notes[0], "the generation algorithm" + of_roi +
                            "is 'by hand, of course' and left out: DICOM has room for 16 capitals, digits, blanks and "
                            "underscores");
    EXPECT_EQ(notes[1], "the description" + of_roi +
                            "is longer than the 1024 characters for which DICOM has room; its end is left out");
    EXPECT_NE(notes[2].find("is '1' of 'sssssssssssssssss' and left out"), std::string::npos) << notes[2];
    EXPECT_NE(notes[3].find("'density!' and left out"), std::string::npos) << notes[3];
    const StructureAttributes again = read_rtstruct(path()).rois.front().contours.attributes;
    EXPECT_EQ(again.interpreted_type, "ORGAN");
    EXPECT_EQ(again.description, std::string(1024, 'x'));
    EXPECT_EQ(again.generation_algorithm, "");
    verdict();
    attributes.physical_properties = {{"REL_ELEC_DENSITY", NAN}};
    EXPECT_KONTUR_ERROR(write(roi), ErrorKind::invalid_input, "is no number");
    attributes.description = "Leb\xe4r";
    EXPECT_KONTUR_ERROR(write(roi), ErrorKind::invalid_input, "is not UTF-8");
}

TEST_F(WriteRtstruct, TellsNamesApartThatDicomWouldMakeEqual) {
    use_images("axial");
    const std::string long_name(64, 'x');
    StructureSet set{"a label of more than 16 characters", {}};
    for (const std::string& name : {long_name + "left", long_name + "right", std::string("a/b"), std::string("a\\b"),
                                    std::string("a\\b"), std::string("a/b"), std::string("a/b (2)")})
        set.rois.emplace_back().name = name;
    const std::vector<std::string> notes = write_rtstruct(path(), set, series_);
    std::vector<std::string> names;
    for (const Roi& roi : read_rtstruct(path()).rois) names.push_back(roi.name);
    EXPECT_EQ(names, (std::vector<std::string>{long_name, std::string(60, 'x') + " (2)", "a/b", "a/b (2)", "a/b (3)", "a/b",
                                               "a/b (2) (2)"}))
        << "of names that were equal before, nothing is said";
    ASSERT_EQ(notes.size(), 6u) << "also of the label";
    EXPECT_NE(notes[2].find("'a\\b' of ROI 4 would be that of another one"), std::string::npos) << notes[2];
    EXPECT_NE(notes[5].find("label has 34 characters, of which DICOM has room for 16"), std::string::npos) << notes[5];
    verdict();
    set.rois[1].name = "Leb\xe4r";
    EXPECT_KONTUR_ERROR(write_rtstruct(path(), set, series_), ErrorKind::invalid_input,
                        "the name of ROI 2, 'Leb?r' is not UTF-8");
}

TEST_F(WriteRtstruct, RefusesWhatItCannotSay) {
    use_images("axial");
    const auto refused = [&](const auto& change) {
        Roi roi = holes();
        change(roi.contours);
        try {
            write(roi);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const std::string roi = "ROI 1 'L\xC3\xA4sion \xD0\x96': ";
    EXPECT_EQ(refused([](ContourSet& set) { set.contours[1].closed = false; }),
              roi + "contour 2: it is open; only closed contours can be written");
    EXPECT_EQ(refused([](ContourSet& set) { set.contours[4].points.resize(2); }),
              roi + "contour 5: it has 2 points; at least 3 are needed");
    EXPECT_EQ(refused([](ContourSet& set) { set.contours[5].points[3].y = NAN; }),
              roi + "contour 6: it has a NaN or infinite coordinate");
    EXPECT_EQ(refused([](ContourSet& set) { set.contours[5].hole = true; }),
              roi + "contour 6: it is a hole that no contour encloses");
    EXPECT_NE(refused([](ContourSet& set) { set.interior.push_back({}); }).find("points inside"), std::string::npos);
    EXPECT_FALSE(fs::exists(path()));
    EXPECT_KONTUR_ERROR(write_rtstruct(path(), {}, {}), ErrorKind::invalid_input, "the image series has no files");
}

/// Proper crossings of the path's edges with each other.
int crossings(const std::vector<Vec3>& path) {
    const auto side = [](const Vec3& a, const Vec3& b, const Vec3& p) { return cross(b - a, p - a).z; };
    int found = 0;
    for (std::size_t m = 0; m < path.size(); ++m)
        for (std::size_t n = 0; n < m; ++n) {
            const Vec3 &a = path[m], &b = path[(m + 1) % path.size()], &c = path[n], &d = path[(n + 1) % path.size()];
            found += side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
        }
    return found;
}

double signed_area(const std::vector<Vec3>& path) {
    double twice = 0;
    for (std::size_t n = 0; n < path.size(); ++n) twice += cross(path[n], path[(n + 1) % path.size()]).z;
    return twice / 2;
}

TEST(JoinKeyhole, EnclosesTheOuterRingLessItsHolesWithoutCrossingItself) {
    std::mt19937 random = test::random_of_this_test();
    std::uniform_real_distribution<double> jitter(0.1, 0.45);
    std::bernoulli_distribution turned(0.5);
    const Plane plane;
    for (int round = 0; round < 20; ++round) {
        const std::vector<Vec3> outer{{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}};
        std::vector<std::vector<Vec3>> holes;
        double area = 36;
        for (int i = 0; i < 5; ++i)  // on a lattice, so that many corners lie on common lines
            for (int j = 0; j < 5; ++j) {
                holes.push_back(ring(plane, i + 1, j + 1, round == 0 ? 0.25 : jitter(random), round == 0 ? 4 : 7));
                area -= std::abs(signed_area(holes.back()));
                if (turned(random)) std::reverse(holes.back().begin(), holes.back().end());
            }
        const std::vector<Vec3> path = join_keyhole(outer, holes, plane);
        EXPECT_EQ(crossings(path), 0);
        EXPECT_NEAR(std::abs(signed_area(path)), area, 1e-9) << "holes run against the outer ring";
        EXPECT_EQ(split_keyhole(path, 1e-3).size(), 26u);
    }
}

TEST_F(WriteRtstruct, NamesANewFrameOfReferenceWhereTheImagesNameNone) {
    for (const char* images : {"no_frame", "anonymised"}) {
        use_images(images);
        EXPECT_EQ(series_.frame_of_reference_uid, "") << images;
        EXPECT_EQ(write(holes()),
                  (std::vector<std::string>{"the images name no common frame of reference; the structure set "
                                            "names a new one"}));
        const std::string uid = read_rtstruct(path()).rois.front().frame_of_reference_uid;
        ASSERT_FALSE(uid.empty());
        const std::string bytes = test::read_bytes(path());
        std::size_t times = 0;
        for (std::size_t at = bytes.find(uid); at != std::string::npos; at = bytes.find(uid, at + 1)) ++times;
        EXPECT_EQ(times, 3u) << "of the file, of the list of frames, of the ROI";
    }
}

}  // namespace
}  // namespace kontur
