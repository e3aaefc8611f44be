// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/contour_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/io/contours.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/phantom/cases.h"
#include "support/contour_sets.h"
#include "support/polygons.h"
#include "support/random.h"
#include "support/test_data.h"

namespace kontur {
namespace {

using Kind = FindingKind;
using test::Point2;

const Plane kAxial{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};

Plane axial_at(double z) { return {{0, 0, z}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}}; }

Contour rectangle(const Plane& plane, double u0, double u1, double v0, double v1) {
    return test::contour_in(plane, std::vector<Point2>{{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}});
}

/// Circles of a ball of 20 mm in three axial planes; nothing is wrong with them.
ContourSet ball() {
    ContourSet set;
    for (const double z : {-8.0, 0.0, 8.0}) set.contours.push_back(test::circle(axial_at(z), std::sqrt(400 - z * z), 60));
    return set;
}

ContourSet ball_and(const Contour& contour) {
    ContourSet set = ball();
    set.contours.push_back(contour);
    return set;
}

std::vector<Finding> of_kind(const std::vector<Finding>& findings, Kind kind) {
    std::vector<Finding> result;
    std::copy_if(findings.begin(), findings.end(), std::back_inserter(result),
                 [&](const Finding& f) { return f.kind == kind; });
    return result;
}

/// The only finding of a kind.
Finding only(const ContourSet& set, Kind kind) {
    const std::vector<Finding> found = of_kind(check_contour_set(set), kind);
    EXPECT_EQ(found.size(), 1u) << name(kind);
    return found.size() == 1 ? found.front() : Finding{};
}

std::size_t count(const ContourSet& set, Kind kind) { return of_kind(check_contour_set(set), kind).size(); }

TEST(ContourCheck, NothingIsWrongWithSectionsOfABody) {
    EXPECT_TRUE(check_contour_set(ball()).empty());
    for (const char* drawn : {"liver_orthogonal14", "metastasis_parallel7", "vertebra_parallel11", "kidney_radial6"})
        EXPECT_TRUE(check_contour_set(phantom_case(drawn).contours).empty()) << drawn;
}

TEST(ContourCheck, EmptySet) { EXPECT_EQ(only({}, Kind::no_contours).severity, Severity::error); }

TEST(ContourCheck, ErrorsNameTheContourAndThePlace) {
    const Finding few = only(ball_and({kAxial, {{1, 2, 0}, {1, 2, 0}, {5, 2, 0}, {1, 2, 0}}}), Kind::too_few_points);
    EXPECT_EQ(few.severity, Severity::error);
    EXPECT_EQ(few.contour, 3u);
    EXPECT_EQ(few.text, "contour 4 has 2 different points; at least 3 are needed");
    EXPECT_EQ(few.position, (Vec3{1, 2, 0}));

    Contour lifted = rectangle(axial_at(4), -5, 5, -5, 5);
    lifted.points[2].z += 0.5;
    const Finding off = only(ball_and(lifted), Kind::off_plane);
    EXPECT_EQ(off.severity, Severity::error);
    EXPECT_EQ(off.position, (Vec3{5, 5, 4.5}));
    EXPECT_NEAR(*off.value_mm, 0.5, 1e-12);

    Contour infinite = rectangle(axial_at(4), -5, 5, -5, 5);
    infinite.points[1].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(only(ball_and(infinite), Kind::not_finite).severity, Severity::error);
    ContourSet line;
    line.contours.push_back(rectangle(axial_at(4), -5, 5, 0, 0.001));
    EXPECT_EQ(only(line, Kind::no_area).severity, Severity::error);
    const Finding left_out = only(ball_and(line.contours.front()), Kind::no_area);
    EXPECT_EQ(left_out.severity, Severity::warning) << "others show the object";
    EXPECT_EQ(left_out.text, "contour 4 has no area: it is 0.001 mm wide; it is left out");

    Contour open_hole = rectangle(axial_at(4), -5, 5, -5, 5);
    open_hole.closed = false;
    open_hole.hole = true;
    const Finding unusable = only(ball_and(open_hole), Kind::unusable);
    EXPECT_EQ(unusable.text.rfind("contour 4 ", 0), 0u) << unusable.text;
}

TEST(ContourCheck, ErrorsComeFirst) {
    ContourSet set = ball_and({kAxial, {{0, 0, 0}, {1, 0, 0}}});
    set.contours[0].points.insert(set.contours[0].points.begin(), set.contours[0].points.front());
    const std::vector<Finding> found = check_contour_set(set);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].kind, Kind::too_few_points);
    EXPECT_EQ(found[1].kind, Kind::repeated_points);
}

TEST(ContourCheck, RepeatedPoints) {
    Contour contour = rectangle(axial_at(4), -15, 15, -15, 15);
    contour.points.insert(contour.points.begin() + 2, 3, contour.points[2]);
    contour.points.push_back(contour.points.front());
    const Finding found = only(ball_and(contour), Kind::repeated_points);
    EXPECT_EQ(found.text, "contour 4 repeats 4 points");
    EXPECT_EQ(found.severity, Severity::note);
    EXPECT_EQ(found.position, contour.points[2]);
}

TEST(ContourCheck, SpikesExactAndNarrow) {
    const auto with_spike = [](double width) {
        return ball_and(test::contour_in(
            axial_at(4), std::vector<Point2>{{-9, -9}, {9, -9}, {9, -width}, {30, 0}, {9, width}, {9, 9}, {-9, 9}}));
    };
    for (const double width : {0.0, 1e-9, 0.2}) {
        const Finding found = only(with_spike(width), Kind::spike);
        EXPECT_EQ(found.severity, Severity::warning);
        EXPECT_GT(found.position->x, 8.9) << width;
    }
    EXPECT_EQ(count(with_spike(3), Kind::spike), 0u);
}

TEST(ContourCheck, CrossingAndTouchingItselfAreToldApart) {
    const Contour eight = test::contour_in(axial_at(4), std::vector<Point2>{{-9, -9}, {9, 9}, {9, -9}, {-9, 9}});
    const Finding crossing = only(ball_and(eight), Kind::self_crossing);
    EXPECT_EQ(crossing.severity, Severity::warning);
    EXPECT_LT(distance(*crossing.position, {0, 0, 4}), 1e-12);
    EXPECT_EQ(count(ball_and(eight), Kind::self_touch), 0u);

    const Contour touching = test::contour_in(
        axial_at(4), std::vector<Point2>{{0, 0}, {8, -4}, {12, 0}, {8, 4}, {0, 0}, {-8, 4}, {-12, 0}, {-8, -4}});
    EXPECT_EQ(only(ball_and(touching), Kind::self_touch).severity, Severity::note);
    EXPECT_EQ(count(ball_and(touching), Kind::self_crossing), 0u);
}

TEST(ContourCheck, ClosedThatWasLeftOpenAndOpenThatIsClosed) {
    Contour arc = test::circle(axial_at(4), 15, 100);
    arc.points.resize(70);
    const Finding open = only(ball_and(arc), Kind::maybe_open);
    EXPECT_NEAR(*open.value_mm, distance(arc.points.front(), arc.points.back()), 1e-12);
    EXPECT_EQ(open.severity, Severity::warning);
    arc.closed = false;
    EXPECT_EQ(count(ball_and(arc), Kind::maybe_open), 0u);
    EXPECT_EQ(count(ball_and(arc), Kind::maybe_closed), 0u);

    Contour circle = test::circle(axial_at(4), 15, 100);
    circle.closed = false;
    EXPECT_EQ(only(ball_and(circle), Kind::maybe_closed).severity, Severity::warning);
}

TEST(ContourCheck, LongEdges) {
    Contour contour = test::circle(axial_at(4), 15, 100);
    contour.points.erase(contour.points.begin() + 20, contour.points.begin() + 50);
    EXPECT_NEAR(*only(ball_and(contour), Kind::long_edge).value_mm, 2 * 15 * std::sin(0.31 * M_PI), 1e-9);
    EXPECT_EQ(count(ball_and(rectangle(axial_at(4), -15, 15, -2, 2)), Kind::long_edge), 0u) << "drawn by its corners";
}

TEST(ContourCheck, TinyBesideTheOthers) {
    EXPECT_EQ(only(ball_and(rectangle(axial_at(4), 0, 0.1, 0, 5)), Kind::tiny).contour, 3u);
    EXPECT_EQ(count(ball_and(rectangle(axial_at(4), 0, 1, 0, 5)), Kind::tiny), 0u);
}

TEST(ContourCheck, DuplicatesEvenReversedOrResampled) {
    ContourSet set = ball();
    Contour again = set.contours[1];
    std::reverse(again.points.begin(), again.points.end());
    const Finding found = only(ball_and(again), Kind::duplicate);
    EXPECT_EQ(found.contour, 3u);
    EXPECT_EQ(found.other, 1u);
    EXPECT_EQ(only(ball_and(test::circle(kAxial, 20, 300)), Kind::duplicate).other, 1u);
    for (const Kind kind : {Kind::overlap, Kind::unmarked_hole}) EXPECT_EQ(count(ball_and(again), kind), 0u);
    EXPECT_EQ(count(ball_and(test::circle(kAxial, 10, 60)), Kind::duplicate), 0u);
}

TEST(ContourCheck, LinesSoNearThatTheyAreOneOrLeaveAThinWall) {
    const Finding one = only(ball_and(test::circle(kAxial, 19, 60)), Kind::duplicate);
    EXPECT_EQ(one.contour, 3u);
    EXPECT_EQ(one.other, 1u);
    EXPECT_NEAR(one.value_mm.value_or(0), 1, 0.01) << one.text;
    ContourSet wall;
    wall.contours = {test::circle(kAxial, 20, 60), test::circle(kAxial, 19.5, 60)};
    const Finding thin = only(wall, Kind::thin_wall);
    EXPECT_EQ(thin.contour, 1u);
    EXPECT_EQ(thin.other, 0u);
    EXPECT_NE(thin.text.find("leaves a wall of 0.5 mm"), std::string::npos) << thin.text;
    EXPECT_EQ(count(wall, Kind::unmarked_hole), 0u);
}

TEST(ContourCheck, HolesAndOverlaps) {
    Contour inner = rectangle(kAxial, -5, 5, -5, 5);
    const Finding unmarked = only(ball_and(inner), Kind::unmarked_hole);
    EXPECT_EQ(unmarked.contour, 3u);
    EXPECT_EQ(unmarked.other, 1u);
    EXPECT_EQ(unmarked.severity, Severity::note) << "it becomes a hole";
    inner.hole = true;
    EXPECT_TRUE(check_contour_set(ball_and(inner)).empty());

    Contour stray = rectangle(kAxial, 30, 40, -5, 5);
    EXPECT_EQ(count(ball_and(stray), Kind::stray_hole), 0u);
    stray.hole = true;
    EXPECT_EQ(only(ball_and(stray), Kind::stray_hole).contour, 3u);

    const Finding overlap = only(ball_and(rectangle(kAxial, 10, 40, -5, 5)), Kind::overlap);
    EXPECT_EQ(overlap.contour, 1u);
    EXPECT_EQ(overlap.other, 3u);
    EXPECT_NEAR(overlap.position->x, std::sqrt(400 - 25), 1);
}

TEST(ContourCheck, HolesAloneAndDistantSurfacePointsAreErrors) {
    ContourSet set = ball();
    for (Contour& contour : set.contours) contour.hole = true;
    EXPECT_EQ(only(set, Kind::unusable).text, "all contours are holes (3); at least 1 must be none");
    set = ball();
    set.surface = {{{1e6, 0, 0}, {}}};
    EXPECT_EQ(only(set, Kind::unusable).severity, Severity::error);
}

TEST(ContourCheck, SurfacePointsOffTheContoursOfTheirPlane) {
    ContourSet set = ball();
    const Vec3 on = set.contours[0].points[3];
    set.surface = {{on, {}}, {set.contours[0].plane.origin, {}}};
    const Finding found = only(set, Kind::misplaced_point);
    EXPECT_NE(found.text.find("surface point 2 lies "), std::string::npos) << found.text;
    EXPECT_GT(*found.value_mm, 10);
}

TEST(ContourCheck, ContradictionsBeyondTheLimit) {
    const Plane sagittal = make_plane({0, 0, 0}, {1, 0, 0});
    EXPECT_TRUE(check_contour_set(ball_and(test::circle(sagittal, 20, 60))).empty());
    const ContourSet larger = ball_and(test::circle(sagittal, 23, 60));
    const std::vector<Finding> found = of_kind(check_contour_set(larger), Kind::contradiction);
    ASSERT_EQ(found.size(), 3u) << "one for each pair of contours";
    for (const Finding& f : found) EXPECT_NEAR(*f.value_mm, 3, 0.3);
    EXPECT_TRUE(of_kind(check_contour_set(larger, {{}, 5.0}), Kind::contradiction).empty());
}

TEST(ContourCheck, ClicksOnTheWrongSide) {
    ContourSet set = ball();
    set.interior = {{0, 0, 0}, {30, 0, 0}, {40, 0, 4}};  // the last one lies in no plane
    set.exterior = {{0, 0, 30}, {35, 0, 0}};
    EXPECT_EQ(only(set, Kind::misplaced_point).position, (Vec3{30, 0, 0}));
    set.interior.clear();
    set.exterior = {{3, 0, 8}};
    EXPECT_EQ(only(set, Kind::misplaced_point).position, (Vec3{3, 0, 8}));
}

TEST(ContourCheck, ContoursThatStandAlone) {
    const Finding found = only(ball_and(rectangle(axial_at(8), 60, 70, 0, 10)), Kind::isolated);
    EXPECT_EQ(found.contour, 3u);
    EXPECT_EQ(found.severity, Severity::note);
}

TEST(ContourCheck, RingsOfATubeThatAreFarApart) {
    const auto arch = [](double step) {
        ContourSet set;
        for (double angle = 0; angle < 2.5; angle += step) {
            const Vec3 along{-std::sin(angle), std::cos(angle), 0}, middle{60 * std::cos(angle), 60 * std::sin(angle), 0};
            set.contours.push_back(test::circle(make_plane(middle, along), 5, 60));
        }
        return set;
    };
    const Finding found = only(arch(0.6), Kind::far_rings);
    EXPECT_EQ(found.severity, Severity::note);
    EXPECT_NEAR(*found.value_mm, 120 * std::sin(0.3), 0.01);
    EXPECT_EQ(*found.other, *found.contour + 1);
    EXPECT_NE(found.text.find("the farthest of 4 such pairs"), std::string::npos) << found.text;
    EXPECT_EQ(count(arch(0.35), Kind::far_rings), 0u);
    EXPECT_EQ(count(test::ball_slices({}, 20, 4, 4), Kind::far_rings), 0u);
}

TEST(ContourCheck, MissingSlices) {
    ContourSet set;
    for (const int slice : {0, 1, 2, 3, 6, 7, 8}) set.contours.push_back(test::circle(axial_at(3 * slice), 20, 60));
    const Finding found = only(set, Kind::gap);
    EXPECT_NEAR(*found.value_mm, 9, 1e-12);
    EXPECT_NEAR(found.position->z, 13.5, 1e-12);
    EXPECT_NE(found.text.find("2 missing"), std::string::npos) << found.text;
    set.contours.clear();
    for (const int slice : {0, 1, 3, 7, 12, 20}) set.contours.push_back(test::circle(axial_at(3 * slice), 20, 60));
    EXPECT_EQ(count(set, Kind::gap), 0u) << "no regular spacing, no gap";
}

TEST(ContourCheck, OnePlaneOnly) {
    ContourSet set;
    set.contours = {rectangle(kAxial, 0, 10, 0, 10), rectangle(kAxial, 20, 30, 0, 10)};
    EXPECT_EQ(only(set, Kind::one_plane).severity, Severity::note);
}

TEST(ContourCheck, UnitsAndOrigin) {
    for (const double scale : {1e-3, 1e3}) {
        ContourSet set = ball();
        for (Contour& contour : set.contours) {
            for (Vec3& p : contour.points) p *= scale;
            contour.plane.origin *= scale;
        }
        EXPECT_EQ(only(set, Kind::implausible_size).severity, Severity::warning);
    }
    ContourSet set = ball();
    for (Contour& contour : set.contours) {
        for (Vec3& p : contour.points) p.x += 1e5;
        contour.plane.origin.x += 1e5;
    }
    EXPECT_NEAR(only(set, Kind::far_away).position->x, 1e5, 1);
}

TEST(ContourCheck, ErrorsAreWhatSegmentingRefuses) {
    // Rectangles with something done to them that may or may not be an error.
    std::mt19937 random = test::random_of_this_test();
    std::uniform_int_distribution<int> damage(0, 7), corner(0, 3);
    int refused = 0;
    for (int round = 0; round < 500; ++round) {
        ContourSet set = ball();
        for (int k = 0; k < 2; ++k) {
            Contour contour = rectangle(axial_at(4 + k), -15, 15, -15, 15);
            Vec3& point = contour.points[static_cast<std::size_t>(corner(random))];
            switch (damage(random)) {
                case 0:
                    point.z += 0.005;
                    break;
                case 1:
                    point.z += 0.05;
                    break;
                case 2:
                    point = contour.points[0];
                    break;
                case 3:
                    contour.closed = false;
                    break;
                case 4:
                    contour.end = ContourEnd::flat;
                    contour.hole = true;
                    break;
                case 5:
                    contour.points.assign(4, point);
                    break;
                case 6:
                    contour.plane.normal *= 1.1;
                    break;
                default:
                    break;
            }
            set.contours.push_back(contour);
        }
        const std::vector<Finding> found = check_contour_set(set);
        const bool error =
            std::any_of(found.begin(), found.end(), [](const Finding& f) { return f.severity == Severity::error; });
        drop_duplicate_points(set);
        EXPECT_EQ(error, !contour_problems(set).empty()) << round;
        refused += error;
    }
    EXPECT_GT(refused, 100);
    EXPECT_LT(refused, 450);
}

TEST(ContourCheckReal, DisagreementsOfAnUnsteadyHandAreFound) {
    KONTUR_REQUIRE_DATA("derived_nonparallel");
    for (const char* object : {"hippocampus_label5", "vertebral_body_L5label"}) {
        const auto folder = test::data_dir() / "derived_nonparallel" / object;
        EXPECT_EQ(count(read_contours(folder / "ortho3x3.json").contours, Kind::contradiction), 0u) << object;
        EXPECT_GT(count(read_contours(folder / "ortho3x3_handdrawn.json").contours, Kind::contradiction), 5u) << object;
    }
}

TEST(ContourCheckReal, SpeckOfABreastPlanAreTinyAndHolesMarked) {
    KONTUR_REQUIRE_DATA("09_rtstruct_breast_dicompyler/rtss.dcm");
    const StructureSet plan = read_rtstruct(test::data_dir() / "09_rtstruct_breast_dicompyler/rtss.dcm");
    const auto lung = std::find_if(plan.rois.begin(), plan.rois.end(), [](const Roi& roi) { return roi.name == "Lt Lung"; });
    ASSERT_NE(lung, plan.rois.end());
    EXPECT_GT(count(lung->contours, Kind::tiny), 20u);
    EXPECT_EQ(count(lung->contours, Kind::unmarked_hole), 0u) << "the reader marks them";
    for (const Finding& finding : check_contour_set(lung->contours)) EXPECT_NE(finding.severity, Severity::error);
}

}  // namespace
}  // namespace kontur
