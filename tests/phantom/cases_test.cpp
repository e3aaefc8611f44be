// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "kontur/base/error.h"
#include "kontur/phantom/dense_liver.h"

namespace kontur {
namespace {

/// The case, made once for all tests.
const PhantomCase& known_case(const std::string& name) {
    static std::map<std::string, PhantomCase> cases;
    const auto found = cases.find(name);
    return found != cases.end() ? found->second : cases.emplace(name, phantom_case(name)).first->second;
}

double cross_uv(const std::array<double, 2>& o, const std::array<double, 2>& a, const std::array<double, 2>& b) {
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/// Proper crossings of a closed polygon with itself, by comparing every pair of its segments.
int self_crossings(const Contour& contour) {
    std::vector<std::array<double, 2>> p;
    for (const Vec3& point : contour.points) p.push_back(contour.plane.to_uv(point));
    const std::size_t n = p.size();
    int crossings = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j) {
            const auto &a = p[i], &b = p[(i + 1) % n], &c = p[j], &d = p[(j + 1) % n];
            crossings += cross_uv(a, b, c) * cross_uv(a, b, d) < 0 && cross_uv(c, d, a) * cross_uv(c, d, b) < 0;
        }
    return crossings;
}

TEST(PhantomCases, AllAreSoundContourSetsInsideTheirGrids) {
    for (const std::string& name : phantom_case_names()) {
        const PhantomCase& c = known_case(name);
        EXPECT_EQ(c.name, name);
        EXPECT_FALSE(c.note.empty());
        EXPECT_NO_THROW(check_contours(c.contours, {.plane_tolerance_mm = 1e-9})) << name;
        EXPECT_NO_THROW(check_grid(c.grid)) << name;
        const Affine3 to_index = c.grid.index_to_mm.inverse();
        for (const Contour& contour : c.contours.contours)
            for (const Vec3& p : contour.points)
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GT(to_index.apply(p)[axis], 1) << name;
                    ASSERT_LT(to_index.apply(p)[axis], static_cast<double>(c.grid.size[axis]) - 2) << name;
                }
    }
}

TEST(PhantomCases, HaveThePapersSizes) {
    const PhantomCase& liver_case = known_case("liver_orthogonal14");
    EXPECT_EQ(liver_case.contours.contours.size(), 14u);
    EXPECT_EQ(2 * point_count(liver_case.contours) + 4, 13796u);
    EXPECT_EQ(liver_case.grid.voxel_count(), 10711151);

    const PhantomCase& metastasis_case = known_case("metastasis_parallel17");
    EXPECT_EQ(metastasis_case.contours.contours.size(), 17u);
    EXPECT_EQ(2 * point_count(metastasis_case.contours) + 4, 6246u);
    EXPECT_EQ(metastasis_case.grid.voxel_count(), 1058508);
    EXPECT_EQ(known_case("metastasis_parallel7").contours.contours.size(), 7u);
}

TEST(PhantomCases, PointsLieOnTheSurfaceEquallySpaced) {
    for (const std::string& name : phantom_case_names()) {
        const PhantomCase& c = known_case(name);
        if (!c.body || name.ends_with("_hand")) continue;
        for (const Contour& contour : c.contours.contours) {
            double shortest = 1e9, longest = 0;
            for (std::size_t i = 0; i < contour.points.size(); ++i) {
                const Vec3 &p = contour.points[i], &next = contour.points[(i + 1) % contour.points.size()];
                ASSERT_LT(std::abs(c.body->value(p)), 1e-9) << name;
                shortest = std::min(shortest, distance(p, next));
                longest = std::max(longest, distance(p, next));
            }
            EXPECT_GT(shortest, 0.6 * longest) << name;
        }
    }
}

TEST(PhantomCases, NormalsAreUnitAndPointOutOfTheBody) {
    for (const std::string& name : phantom_case_names()) {
        const PhantomCase& c = known_case(name);
        ASSERT_EQ(c.normals.size(), c.contours.contours.size()) << name;
        for (std::size_t k = 0; k < c.normals.size(); ++k) {
            const auto& points = c.contours.contours[k].points;
            ASSERT_EQ(c.normals[k].size(), points.size()) << name;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec3& normal = c.normals[k][i];
                ASSERT_NEAR(norm(normal), 1, 1e-12) << name;
                if (!c.body || name.ends_with("_hand")) continue;
                const Vec3 side = any_perpendicular(normal);
                ASSERT_LT(c.body->value(points[i] + 0.05 * normal), 0) << name;
                ASSERT_GT(c.body->value(points[i] - 0.05 * normal), 0) << name;
                for (const Vec3& tangent : {side, cross(normal, side)})  // the surface stays level along it
                    ASSERT_LT(std::abs(c.body->value(points[i] + 1e-3 * tangent)), 1e-5) << name;
            }
        }
    }
}

TEST(PhantomCases, ThinnedSetIsPartOfTheFullOne) {
    const PhantomCase &all = known_case("metastasis_parallel17"), &some = known_case("metastasis_parallel7");
    for (const Contour& contour : some.contours.contours)
        EXPECT_TRUE(
            std::ranges::any_of(all.contours.contours, [&](const Contour& c) { return c.points == contour.points; }));
}

TEST(PhantomCases, VertebraHasNestedContours) {
    const ContourSet set = known_case("vertebra_parallel11").contours;
    EXPECT_GE(std::ranges::count(set.contours, true, &Contour::hole), 3);
}

TEST(PhantomCases, OnlyTheSelfIntersectingSetCrossesItself) {
    for (const std::string& name : phantom_case_names()) {
        if (name.ends_with("_hand")) continue;
        for (const Contour& contour : known_case(name).contours.contours)
            ASSERT_EQ(self_crossings(contour), name == "self_intersecting" ? 1 : 0) << name;
    }
}

TEST(PhantomCases, SelfIntersectingNormalsLeaveBothLobesAndEnterTheInnerLoop) {
    const PhantomCase& c = known_case("self_intersecting");
    for (std::size_t k = 0; k < c.normals.size(); ++k) {
        const Contour& contour = c.contours.contours[k];
        const bool eight = k % 2 == 0;
        const Vec3 origin = contour.plane.origin;
        double reach = 0;
        for (const Vec3& p : contour.points) reach = std::max(reach, p.x - origin.x);
        int tips = 0, inner_tips = 0;
        for (std::size_t i = 0; i < contour.points.size(); ++i) {
            const Vec3 p = contour.points[i] - origin, normal = c.normals[k][i];
            EXPECT_EQ(normal.z, 0);
            const bool tip = eight ? std::abs(p.x) > 0.98 * reach : p.x > 0.98 * reach;
            const bool inner_tip = !eight && std::abs(p.y) < 0.04 * reach && p.x > 0.3 * reach && p.x < 0.5 * reach;
            if (tip) {
                EXPECT_GT(p.x * normal.x, 0) << "contour " << k;
            }
            if (inner_tip) {
                EXPECT_LT(normal.x, 0) << "contour " << k;
            }
            tips += tip;
            inner_tips += inner_tip;
        }
        EXPECT_GE(tips, 2);
        EXPECT_GE(inner_tips, eight ? 0 : 1);
    }
}

TEST(PhantomCases, HandDrawnVariantsStrayAsFarAsStated) {
    for (const auto& [name, rms_mm] :
         {std::pair{"liver_orthogonal14_hand", 0.6}, {"liver_parallel14_hand", 0.6}, {"metastasis_parallel17_hand", 0.24}}) {
        const PhantomCase &drawn = known_case(name),
                          &exact = known_case(std::string(name, std::strlen(name) - std::strlen("_hand")));
        double sum = 0;
        for (std::size_t k = 0; k < drawn.contours.contours.size(); ++k)
            for (std::size_t i = 0; i < drawn.contours.contours[k].points.size(); ++i) {
                const Vec3 d = drawn.contours.contours[k].points[i] - exact.contours.contours[k].points[i];
                sum += dot(d, d);
            }
        const double jitter_mm = rms_mm == 0.6 ? 0.06 : 0.048;
        const double expected = std::sqrt(rms_mm * rms_mm + 2 * jitter_mm * jitter_mm);
        EXPECT_NEAR(std::sqrt(sum / static_cast<double>(point_count(drawn.contours))), expected, 0.02 * expected) << name;
    }
}

TEST(PhantomCases, AreTheSameEveryTime) {
    for (const char* name : {"kidney_radial6_hand", "liver_oblique10"}) {
        const PhantomCase a = phantom_case(name), b = phantom_case(name);
        ASSERT_EQ(a.contours.contours.size(), b.contours.contours.size());
        for (std::size_t k = 0; k < a.contours.contours.size(); ++k)
            EXPECT_EQ(a.contours.contours[k].points, b.contours.contours[k].points) << name;
    }
}

TEST(PhantomCases, RefusesUnknownNames) {
    for (const char* name : {"", "liver", "self_intersecting_hand", "_hand"}) try {
            phantom_case(name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
            EXPECT_NE(std::string(error.what()).find("kidney_radial6"), std::string::npos);
        }
}

TEST(DenseLiverCase, HasThePointsAskedForOnItsSurface) {
    for (const bool orthogonal : {false, true})
        for (const std::size_t points : {std::size_t{500}, std::size_t{3000}, std::size_t{30000}}) {
            if (orthogonal && points > 10000) continue;
            const PhantomCase c = dense_liver_case({.points = points, .orthogonal = orthogonal});
            EXPECT_EQ(point_count(c.contours), points);
            EXPECT_NO_THROW(check_contours(c.contours, {.plane_tolerance_mm = 1e-9}));
            for (const Contour& contour : c.contours.contours)
                for (const Vec3& p : contour.points) ASSERT_LT(std::abs(c.body->value(p)), 1e-8) << points;
        }
    EXPECT_THROW(dense_liver_case({.points = 99}), Error);
}

}  // namespace
}  // namespace kontur
