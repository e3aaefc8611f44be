// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/rtstruct.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/io/contours.h"
#include "support/damage.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

using Marks = std::vector<bool>;

Marks holes(const Roi& roi) {
    Marks marks;
    for (const Contour& contour : roi.contours.contours) marks.push_back(contour.hole);
    return marks;
}

class RtstructTest : public testing::Test {
protected:
    fs::path make(const std::string& name) {
        const fs::path path = folder_ / (name + ".dcm");
        const auto made = test::run_python("make_rtstruct.py", {name, path.string()});
        if (made.exit_code != 0) throw std::runtime_error(made.output);
        return path;
    }

    test::TemporaryFolder folder_;
};

template <typename Call>
std::string refusal(ErrorKind kind, const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(name(error.kind()), name(kind)) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
}

std::string refusal(ErrorKind kind, const fs::path& path) {
    return refusal(kind, [&] { read_rtstruct(path); });
}

bool ends_with(const std::string& text, std::string_view end) { return text.ends_with(end); }

TEST_F(RtstructTest, ReadsNamesNumbersColoursAndPoints) {
    const StructureSet set = read_rtstruct(make("good"));
    EXPECT_EQ(set.label, "TEST");
    ASSERT_EQ(set.rois.size(), 13u);
    const Roi& plain = set.rois[0];
    EXPECT_EQ(plain.number, 1);
    EXPECT_EQ(plain.name, "plain");
    EXPECT_EQ(plain.contours.name, "plain");
    EXPECT_EQ(plain.contours.attributes.interpreted_type, "ORGAN");
    EXPECT_EQ(plain.contours.attributes.color, (std::array<std::uint8_t, 3>{1, 2, 255}));
    EXPECT_TRUE(plain.notes.empty());
    ASSERT_EQ(plain.contours.contours.size(), 2u);
    EXPECT_EQ(plain.contours.contours[1].points, (std::vector<Vec3>{{0, 0, 3}, {10, 0, 3}, {10, 10, 3}, {0, 10, 3}}));
    EXPECT_EQ(plain.contours.contours[1].plane.normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(select_roi(set, "L\xC3\xA4sion").number, 13) << "converted from Latin-1";
    EXPECT_TRUE(select_roi(set, "empty").contours.contours.empty());
}

TEST_F(RtstructTest, ReadsHolesInEachOfTheWaysTheyAreStored) {
    const StructureSet set = read_rtstruct(make("good"));
    const Roi keyhole = select_roi(set, "keyhole");
    ASSERT_EQ(holes(keyhole), (Marks{true, false, true, false}));
    for (const std::size_t n : {0u, 2u}) {
        const double z = n == 0 ? 0 : 5;
        EXPECT_EQ(keyhole.contours.contours[n].points, (std::vector<Vec3>{{2, 2, z}, {2, 6, z}, {6, 6, z}, {6, 2, z}}));
        EXPECT_EQ(keyhole.contours.contours[n + 1].points, (std::vector<Vec3>{{0, 0, z}, {8, 0, z}, {8, 8, z}, {0, 8, z}}));
    }
    EXPECT_EQ(keyhole.notes.front(), "split into outer contours and holes: 2 keyhole contours");

    const Roi wide = select_roi(set, "wide channel");
    EXPECT_EQ(holes(wide), (Marks{false})) << "0.1 mm is no retraced channel";
    EXPECT_EQ(point_count(wide.contours), 10u);

    EXPECT_EQ(holes(select_roi(set, "exclusive")), (Marks{false, true}));
    EXPECT_TRUE(select_roi(set, "exclusive").notes.empty()) << "declared, so nothing was interpreted";

    const Roi nested = select_roi(set, "nested");
    EXPECT_EQ(holes(nested), (Marks{true, false, false, false})) << "hole, outer, island, another slice";
    EXPECT_EQ(nested.notes,
              (std::vector<std::string>{"read as holes, filling even-odd: 1 contour inside others on the slice"}));
}

TEST_F(RtstructTest, SaysWhatItLeftOutAndWhatIsAmbiguous) {
    const StructureSet set = read_rtstruct(make("good"));
    const auto expect = [&](const std::string& roi, std::size_t contours, const std::vector<std::string>& notes) {
        EXPECT_EQ(select_roi(set, roi).contours.contours.size(), contours) << roi;
        EXPECT_EQ(select_roi(set, roi).notes, notes) << roi;
    };
    expect("other types", 3,
           {"left out 1 contour of type OPEN_NONPLANAR", "left out 1 contour without area",
            "read as stretches of the object's boundary: 2 open contours",
            "read as points on the object's surface: 1 single point"});
    expect("without area", 1, {"left out 2 contours without area"});
    expect("repeated", 2,
           {"left out 5 repetitions of another contour",
            "read as holes, filling even-odd: 1 contour inside others on the slice"});
    expect("closing point", 1, {"left out 1 repetition of a neighbouring point"});
    expect("overlapping", 2, {"contours 1 and 2 overlap in part; what any of them encloses is filled"});
    EXPECT_EQ(point_count(select_roi(set, "closing point").contours), 4u);
}

TEST_F(RtstructTest, OpenContoursAndPointsBelongToTheBoundary) {
    const ContourSet set = select_roi(read_rtstruct(make("good")), "other types").contours;
    ASSERT_EQ(set.contours.size(), 3u);
    EXPECT_FALSE(set.contours[0].closed);
    EXPECT_EQ(set.contours[0].points, (std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}));
    EXPECT_TRUE(set.contours[1].closed);
    EXPECT_FALSE(set.contours[1].hole) << "open contours enclose nothing";
    EXPECT_FALSE(set.contours[2].closed);
    EXPECT_EQ(set.contours[2].plane.normal, (Vec3{0, 0, 1})) << "a straight one lies on a slice like the others";
    EXPECT_EQ(set.surface, (std::vector<SurfacePoint>{{{1, 2, 3}, {}}}));
    EXPECT_NO_THROW(check_contours(set));
}

TEST_F(RtstructTest, GivesContoursOfOneSliceOnePlane) {
    const Roi roi = select_roi(read_rtstruct(make("good")), "oblique");
    const auto& contours = roi.contours.contours;
    ASSERT_EQ(contours.size(), 3u);
    EXPECT_LT(distance(contours[0].plane.normal, {0.6, 0, 0.8}), 1e-9);
    EXPECT_EQ(contours[1].plane.normal, contours[0].plane.normal) << "parallel slices have equal normals";
    EXPECT_EQ(contours[2].plane, contours[1].plane);
    EXPECT_NO_THROW(check_contours(roi.contours));
}

TEST_F(RtstructTest, ReadsLongContoursInImplicitAndExplicitRepresentation) {
    for (const char* name : {"long", "explicit"}) {
        const Roi roi = select_roi(read_rtstruct(make(name)), "long");
        ASSERT_EQ(roi.contours.contours.size(), 2u);
        ASSERT_EQ(roi.contours.contours[0].points.size(), 30000u) << name;
        double worst = 0;
        for (const Vec3& p : roi.contours.contours[0].points) worst = std::max(worst, std::abs(std::hypot(p.x, p.y) - 10));
        EXPECT_LT(worst, 1e-6);
    }
}

TEST_F(RtstructTest, JoinsTheItemsThatHoldContoursOfOneRoi) {
    for (const auto& [name, contours] : {std::pair{"twice", 3u}, {"erased", 2u}}) {
        const Roi plain = select_roi(read_rtstruct(make(name)), "plain");
        EXPECT_EQ(plain.contours.contours.size(), contours) << name;
        EXPECT_EQ(plain.notes, (std::vector<std::string>{"its contours stand in 2 items of the file, which are joined"}));
        EXPECT_EQ(plain.contours.attributes.color, (std::array<std::uint8_t, 3>{1, 2, 255})) << name;
    }
}

TEST_F(RtstructTest, DamageInOneRoiLeavesTheOthers) {
    const auto kind = ErrorKind::corrupt_file;
    for (const auto& [name, problem] :
         {std::pair{"number", "contour 2: value 1 is not a decimal number"},
          {"triples", "contour 2: it has 11 coordinates, which is no multiple of 3"},
          {"offset", "contour 2: its ContourOffsetVector is not 0; contours that are shifted by one are not read"},
          {"count", "contour 2: it declares 5 points and has 4"}}) {
        const StructureSet set = read_rtstruct(make(name));
        EXPECT_EQ(set.rois[0].damage, std::string("ROI 1 'plain': ") + problem);
        EXPECT_EQ(refusal(kind, [&] { select_roi(set, "plain"); }), set.rois[0].damage);
        EXPECT_NE(refusal(ErrorKind::invalid_input, [&] { select_roi(set); }).find("1 'plain' (damaged), 2 '"),
                  std::string::npos);
        EXPECT_EQ(select_roi(set, "exclusive").contours.contours.size(), 2u);
    }
}

TEST_F(RtstructTest, LeavesOutObservationsOfNoListedRoi) {
    const fs::path path = make("orphan");
    EXPECT_EQ(select_roi(read_rtstruct(path), "plain").contours.attributes.interpreted_type, "");
    const std::vector<std::string> notes{"left out observations of ROI 99, which is not listed"};
    EXPECT_EQ(read_rtstruct(path).notes, notes);
    EXPECT_EQ(read_contours(path, {.roi = "plain"}).notes, notes);
}

TEST_F(RtstructTest, LeavesOutContoursOfNoListedRoi) {
    const StructureSet set = read_rtstruct(make("unlisted"));
    EXPECT_EQ(set.notes, (std::vector<std::string>{"left out contours of ROI 99, which is not listed"}));
    EXPECT_EQ(select_roi(set, "nested").contours.contours.size(), 4u) << "all others are read";
}

TEST_F(RtstructTest, RefusesContradictionsOfTheWholeFile) {
    const auto kind = ErrorKind::corrupt_file;
    EXPECT_PRED2(ends_with, refusal(kind, make("empty")), "has no list of ROIs or none of contours");
}

TEST_F(RtstructTest, RefusesWhatIsNoStructureSet) {
    test::write_bytes(folder_ / "text.dcm", "not DICOM");
    EXPECT_PRED2(ends_with, refusal(ErrorKind::invalid_input, folder_ / "text.dcm"), "text.dcm: is no DICOM file");
    EXPECT_PRED2(ends_with, refusal(ErrorKind::io, folder_ / "nowhere.dcm"), "nowhere.dcm: no such file");
    KONTUR_REQUIRE_DATA("09_rtstruct_breast_dicompyler");
    for (const auto& entry : fs::directory_iterator(test::data_dir() / "03_sarcoma_STS_002/CT/image")) {
        EXPECT_PRED2(ends_with, refusal(ErrorKind::invalid_input, entry.path()),
                     "no RT structure set but DICOM of modality 'CT'");
        break;
    }
}

TEST_F(RtstructTest, SelectsByNameThenNumberAndListsTheRoisOtherwise) {
    StructureSet set;
    const auto add = [&](std::int64_t number, const std::string& name, std::size_t contours) {
        Roi& roi = set.rois.emplace_back();
        roi.number = number;
        roi.name = name;
        roi.contours.contours.resize(contours);
    };
    EXPECT_EQ(refusal(ErrorKind::invalid_input, [&] { select_roi(set); }), "no ROI has contours; the ROIs are: none");
    add(1, "liver", 3);
    add(2, "marker", 0);
    EXPECT_EQ(select_roi(set).name, "liver");
    EXPECT_EQ(select_roi(set, "2").name, "marker");
    add(3, "2", 1);
    add(4, "liver", 1);
    EXPECT_EQ(select_roi(set, "2").number, 3) << "a name goes before a number";
    const std::string list =
        "; the ROIs are: 1 'liver' (3 contours), 2 'marker' (0 contours), 3 '2' (1 contour), 4 'liver' (1 contour)";
    EXPECT_EQ(refusal(ErrorKind::invalid_input, [&] { select_roi(set); }),
              "several ROIs have contours; choose one with the option roi" + list);
    EXPECT_EQ(refusal(ErrorKind::invalid_input, [&] { select_roi(set, "spleen"); }), "there is no ROI 'spleen'" + list);
    EXPECT_EQ(refusal(ErrorKind::invalid_input, [&] { select_roi(set, "liver"); }),
              "2 ROIs have the name 'liver'; give a number" + list);
}

TEST_F(RtstructTest, SelectsByNameInCapitalsOrNot) {
    StructureSet set;
    for (const char* name : {"Bladder", "GTV", "gtv", "L\xC3\xA4sion", "Ptv 1", "PTV 1"}) {
        Roi& roi = set.rois.emplace_back();
        roi.number = static_cast<std::int64_t>(set.rois.size());
        roi.name = name;
    }
    EXPECT_EQ(select_roi(set, "bladder").number, 1);
    EXPECT_EQ(select_roi(set, "L\xC3\x84SION").number, 4) << "letters with accents, too";
    EXPECT_EQ(select_roi(set, "GTV").number, 2) << "as it is written goes before all others";
    EXPECT_EQ(select_roi(set, "gtv").number, 3);
    EXPECT_TRUE(refusal(ErrorKind::invalid_input, [&] {
                    select_roi(set, "ptv 1");
                }).starts_with("the names of 2 ROIs are 'ptv 1' but for case; give one as it is written; the ROIs are: "));
}

TEST_F(RtstructTest, EndsCleanlyOnEveryDamagedFile) {
    const std::string bytes = test::read_bytes(make("good"));
    const fs::path path = folder_ / "damaged.dcm";
    int refused = 0;
    const auto read_damaged = [&](const std::string& damaged) {
        test::write_bytes(path, damaged);
        try {
            read_rtstruct(path);
        } catch (const Error& error) {
            ++refused;
        }
    };
    test::for_each_prefix(bytes, 61, read_damaged);
    EXPECT_EQ(refused, static_cast<int>((bytes.size() + 60) / 61)) << "no prefix is a whole structure set";
    test::for_each_mutant(bytes, 400, 7, read_damaged);
}

struct RealRoi {
    const char* name;
    std::size_t contours;
    std::ptrdiff_t holes;
};

TEST(RtstructReal, DicompylerHasTheKnownRois) {
    KONTUR_REQUIRE_DATA("09_rtstruct_breast_dicompyler/rtss.dcm");
    const StructureSet set = read_rtstruct(test::data_dir() / "09_rtstruct_breast_dicompyler/rtss.dcm");
    constexpr RealRoi kKnown[] = {{"BODY", 141, 2},     {"Areola", 0, 0},          {"Borders", 2, 0}, {"Breast", 48, 0},
                                  {"Heart", 33, 0},     {"Lt Lung", 165, 77},      {"Nodes", 4, 0},   {"Scar", 6, 0},
                                  {"Tumor Bed", 18, 0}, {"Tumor Bed Block", 24, 0}};
    ASSERT_EQ(set.rois.size(), std::size(kKnown));
    for (std::size_t n = 0; n < set.rois.size(); ++n) {
        EXPECT_EQ(set.rois[n].name, kKnown[n].name);
        const Marks marks = holes(set.rois[n]);
        EXPECT_EQ(marks.size(), kKnown[n].contours) << kKnown[n].name;
        EXPECT_EQ(std::count(marks.begin(), marks.end(), true), kKnown[n].holes) << kKnown[n].name;
        if (marks.empty()) continue;
        EXPECT_NO_THROW(check_contours(set.rois[n].contours)) << kKnown[n].name;
    }
}

}  // namespace
}  // namespace kontur
