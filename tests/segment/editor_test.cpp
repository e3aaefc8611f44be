// SPDX-License-Identifier: Apache-2.0
#include "kontur/editor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kontur/extract/surface_band.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/drawing.h"
#include "kontur/segment.h"
#include "kontur/shape/predicates.h"
#include "segment/same_function.h"
#include "support/coarse_grid.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/solids.h"

namespace kontur {
namespace {

using test::expect_same_function;

/// Distances of the mesh's points from the zero level of the function, to first order.
std::vector<double> distances(const TriangleMesh& mesh, const ImplicitFunction& function) {
    std::vector<double> values(mesh.points.size());
    std::vector<Vec3> gradients(mesh.points.size());
    function.values(mesh.points, values);
    function.gradients(mesh.points, gradients);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::abs(values[i]) / std::max(norm(gradients[i]), 0.1);
    std::ranges::sort(values);
    return values;
}

/// A contour of the body in a plane of any direction near its middle.
Contour random_section(const Body& body, std::mt19937& random) {
    std::normal_distribution<double> direction;
    std::uniform_real_distribution<double> part(-0.25, 0.25);
    const Vec3 size = body.bounds().size();
    for (;;) {
        const Vec3 origin =
            body.bounds().center() + Vec3{part(random) * size.x, part(random) * size.y, part(random) * size.z};
        const Plane plane = make_plane(origin, normalized({direction(random), direction(random), direction(random)}));
        const ContourSet sections = draw_sections(body, {&plane, 1}, 150);
        if (!sections.contours.empty()) return sections.contours.front();
    }
}

/// Adds, removes or replaces one contour.
void edit_at_random(ContourSet& set, const Body& body, std::mt19937& random) {
    const auto some = std::uniform_int_distribution<std::size_t>(0, set.contours.size() - 1)(random);
    const auto at = set.contours.begin() + static_cast<std::ptrdiff_t>(some);
    const int what = std::uniform_int_distribution<int>(0, 2)(random);
    if (what == 0 && set.contours.size() > 5) {
        set.contours.erase(at);
    } else if (what == 1) {
        *at = random_section(body, random);
    } else {
        set.contours.insert(at, random_section(body, random));
    }
}

TEST(Editor, FinishesToTheFunctionOfSegmentAfterAnyEdits) {
    std::mt19937 random = test::random_of_this_test();
    const PhantomCase c = phantom_case("metastasis_parallel7");
    const Grid small_grid = test::coarse(c.grid, 6);
    ContourSet set = c.contours;
    Editor editor({.segment = {}, .preview_spacing_mm = 2, .finished_spacing_mm = 4});
    for (int edit = 0; edit < 4; ++edit) {
        edit_at_random(set, *c.body, random);
        editor.preview(set);
        const EditedSurface finished = editor.finish(set);
        EXPECT_TRUE(finished.finished);
        EXPECT_LT(finished.residual.max_mm, 0.2);
        expect_same_function(finished.function, segment(set, small_grid).function);
    }
}

TEST(Editor, PreviewsWithinAboutHalfAMillimetreOverRandomEdits) {
    std::mt19937 random = test::random_of_this_test();
    for (const char* name : {"metastasis_parallel7_hand", "kidney_radial6"}) {
        const PhantomCase c = phantom_case(name);
        ContourSet set = c.contours;
        Editor editor({.segment = {}, .preview_spacing_mm = 1, .finished_spacing_mm = 4});
        for (int edit = 0; edit < 6; ++edit) {
            edit_at_random(set, *c.body, random);
            const EditedSurface preview = editor.preview(set);
            EXPECT_FALSE(preview.finished);
            ASSERT_FALSE(preview.mesh.points.empty());
            const std::vector<double> off = distances(preview.mesh, editor.finish(set).function);
            EXPECT_LT(off[off.size() * 98 / 100], 0.55) << name << ", edit " << edit << ", worst " << off.back();
        }
    }
}

TEST(Editor, PreviewsAPartOfThePointsAndKeepsTheTilts) {
    const PhantomCase c = phantom_case("liver_orthogonal14");
    Editor editor;
    EXPECT_LE(editor.preview(c.contours).solves, 6);
    ContourSet set = c.contours;
    set.contours.pop_back();
    const EditedSurface second = editor.preview(set);
    EXPECT_LE(second.solves, 4);
    EXPECT_LT(second.function.centers().size(), 2600u);
    EXPECT_GT(second.function.centers().size(), 1200u);
}

/// One contour after the other, moved in its plane.
void drag(ContourSet& set, std::size_t edit) {
    Contour& contour = set.contours[edit % set.contours.size()];
    const Vec3 by = (edit % 2 ? 0.01 : -0.015) * diameter_mm(set) * contour.plane.u;
    contour.plane.origin += by;
    for (Vec3& p : contour.points) p += by;
}

double mean(const std::vector<double>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

TEST(Editor, PreviewsContoursThatAreDraggedWithTheTiltsOfBefore) {
    for (const char* name : {"metastasis_parallel7_hand", "liver_oblique10"}) {
        ContourSet set = phantom_case(name).contours;
        Editor editor;
        int solves = 0, solves_anew = 0;
        EditedSurface dragged = editor.preview(set), anew = dragged;
        for (std::size_t edit = 0; edit < 8; ++edit) {
            drag(set, edit);
            dragged = editor.preview(set);
            anew = Editor().preview(set);
            solves += dragged.solves;
            solves_anew += anew.solves;
        }
        EXPECT_LE(solves, solves_anew - 16) << name << ": both rounds are saved";
        const ImplicitFunction finished = editor.finish(set).function;
        EXPECT_LT(mean(distances(dragged.mesh, finished)), 2.5 * mean(distances(anew.mesh, finished))) << name;
    }
}

TEST(Editor, FindsTiltsAnewWhereContoursComeGoOrLieElsewhere) {
    ContourSet set = test::ball_contours();
    Editor editor;
    editor.preview(set);
    const auto solves_after = [&](const auto& change) {
        drag(set, 0);
        const int usual = editor.preview(set).solves;
        change();
        return editor.preview(set).solves - usual;
    };
    EXPECT_GE(solves_after([&] { set.contours.pop_back(); }), 1);
    EXPECT_GE(solves_after([&] { set.contours.push_back(test::circle(make_plane({0, 0, 9}, {0, 0, 1}), 17, 80)); }), 1);
    EXPECT_GE(solves_after([&] { set.contours[0] = test::circle(make_plane({0, 0, 0}, {0, 1, 1}), 20, 80); }), 1);
    EXPECT_LE(solves_after([&] { drag(set, 1); }), 0);
}

TEST(Editor, IsAheadOfItsMeshWithTheSameSurface) {
    const PhantomCase c = phantom_case("metastasis_parallel7");
    Editor editor, other;
    int told = 0;
    const EditedSurface preview = editor.preview(c.contours, {}, [&](const SurfaceBand& band) {
        ++told;
        EXPECT_EQ(band.cut(c.contours.contours[3].plane).size(), 1u);
    });
    EXPECT_EQ(told, 1);
    EXPECT_EQ(preview.mesh.points, other.preview(c.contours).mesh.points);
    editor.preview({}, {}, [&](const SurfaceBand&) { ++told; });
    EXPECT_EQ(told, 1) << "no contours, no surface";
}

TEST(Editor, SpacingsFollowTheContoursUnlessGiven) {
    const ContourSet ball = test::ball_contours();
    Editor editor;
    const EditedSurface preview = editor.preview(ball), finished = editor.finish(ball);
    EXPECT_DOUBLE_EQ(finished.spacing_mm, 0.01 * diameter_mm(ball));
    EXPECT_DOUBLE_EQ(preview.spacing_mm, 2 * finished.spacing_mm);
    EXPECT_GT(finished.mesh.triangles.size(), 3 * preview.mesh.triangles.size());
    Editor fixed({.segment = {}, .preview_spacing_mm = 3, .finished_spacing_mm = 2});
    EXPECT_EQ(fixed.preview(ball).spacing_mm, 3);
    EXPECT_EQ(fixed.finish(ball).spacing_mm, 2);
}

/// Of two spheres about the origin, in three planes.
ContourSet shell(double radius_mm, double wall_mm) {
    ContourSet set;
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
        for (const double radius : {radius_mm, radius_mm - wall_mm}) {
            Contour& circle = set.contours.emplace_back();
            circle.plane = make_plane({}, normal);
            for (int n = 0; n < 120; ++n) {
                const double angle = 2 * std::numbers::pi * n / 120;
                circle.points.push_back(circle.plane.from_uv(radius * std::cos(angle), radius * std::sin(angle)));
            }
        }
    return set;
}

TEST(Editor, StepsAreFinerWhereWhatWasDrawnIsNarrow) {
    Editor editor;
    const ContourSet thick = shell(40, 10), thin = shell(40, 2.4), thinnest = shell(40, 0.5);
    EXPECT_DOUBLE_EQ(editor.finish(thick).spacing_mm, 0.01 * diameter_mm(thick));
    EXPECT_NEAR(editor.finish(thin).spacing_mm, 2.4 / 4, 0.01);
    EXPECT_DOUBLE_EQ(editor.finish(thinnest).spacing_mm, 0.005 * diameter_mm(thinnest));
}

/// As a mouse that tells a thousand places a second leaves them.
ContourSet with_points_between(ContourSet set, int between) {
    for (Contour& contour : set.contours) {
        std::vector<Vec3> points;
        for_each_edge(contour.points, [&](const Vec3& a, const Vec3& b) {
            for (int n = 0; n < between; ++n) points.push_back(a + (n / static_cast<double>(between)) * (b - a));
        });
        contour.points = std::move(points);
    }
    return set;
}

TEST(Editor, PreviewsOfLinesWithVeryManyPointsLookAtAPartOfThem) {
    const ContourSet few = phantom_case("kidney_radial6").contours, many = with_points_between(few, 12);
    Editor editor({.segment = {}, .preview_spacing_mm = 1});
    const EditedSurface preview = editor.preview(many);
    const std::vector<double> off = distances(preview.mesh, editor.finish(many).function);
    EXPECT_LT(off[off.size() * 98 / 100], 0.55);
    EXPECT_LT(preview.function.centers().size(), 2600u);
}

TEST(Editor, NoContoursGiveNoSurface) {
    Editor editor;
    EXPECT_TRUE(editor.preview({}).mesh.points.empty());
    EXPECT_TRUE(editor.finish({}).mesh.points.empty());
    EXPECT_TRUE(editor.finish({}).finished);
}

TEST(Editor, GoesOnAfterContoursThatCannotBeFitted) {
    ContourSet bad = test::ball_contours();
    bad.contours[2].points.resize(2);
    Editor editor;
    editor.preview(test::ball_contours());
    EXPECT_KONTUR_ERROR(editor.preview(bad), ErrorKind::invalid_input, "contour 3 has 2 points");
    EXPECT_EQ(editor.preview(test::ball_contours()).solves, 1) << "the tilts of the last good edit are still known";
}

TEST(Editor, TheWorstContourIsNumberedAsTheContoursCame) {
    ContourSet set = test::ball_contours();
    Contour& off = set.contours.back();
    for (Vec3& p : off.points) p = off.plane.origin + 1.2 * (p - off.plane.origin);
    set.contours.insert(set.contours.begin() + 1, set.contours[0]);  // a repetition, which is left out
    EXPECT_EQ(Editor().finish(set).residual.worst_contour, set.contours.size() - 1);
}

TEST(Editor, AFinishedSurfaceIsHeldAgainstItsDrawing) {
    ContourSet set = test::ball_contours();
    set.contours.insert(set.contours.begin() + 1, set.contours[0]);  // a repetition, which is left out
    EXPECT_TRUE(Editor().preview(set).section_check.planes.empty());
    const SectionCheck check = Editor().finish(set).section_check;
    EXPECT_TRUE(sentences(check).empty());
    ASSERT_EQ(check.planes.size(), set.contours.size() - 1);
    EXPECT_EQ(check.planes.back().contour, set.contours.size() - 1);
}

TEST(Editor, TheSidesOfOpenLinesAreNumberedAsTheContoursCame) {
    const Body ball = test::ball_solid({0, 0, 0}, 20);
    const std::vector<Plane> planes{make_plane({0, 0, 0}, {0, 0, 1}), make_plane({0, 0, 8}, {0, 0, 1}),
                                    make_plane({0, 0, 0}, {0, 1, 0})};
    ContourSet set = draw_sections(ball, planes, 80);
    ASSERT_EQ(set.contours.size(), 3u);
    set.contours[2].closed = false;
    set.contours[2].points.resize(50);
    set.contours.insert(set.contours.begin() + 1, set.contours[0]);  // a repetition, which is left out
    Editor editor;
    for (const EditedSurface& surface : {editor.preview(set), editor.finish(set)}) {
        ASSERT_EQ(surface.sides.size(), 1u);
        EXPECT_EQ(surface.sides[0].contour, 3u);
        EXPECT_TRUE(surface.sides[0].is_sure);
        const Contour& line = set.contours[3];
        const Vec3 left = cross(line.plane.normal, line.points[1] - line.points[0]);
        const bool is_left = dot(surface.function.gradient(line.points[0]), left) > 0;
        EXPECT_EQ(surface.sides[0].inside, is_left ? Hand::left : Hand::right);
    }
    set.contours[3].inside = Hand::left;
    EXPECT_TRUE(editor.preview(set).sides.empty()) << "it tells";
}

}  // namespace
}  // namespace kontur
