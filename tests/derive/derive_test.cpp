// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derive.h"

#include <gtest/gtest.h>

#include "kontur/base/error.h"
#include "kontur/extract/rasterize.h"
#include "kontur/segment.h"
#include "solid_levels.h"
#include "support/random.h"

namespace kontur {
namespace {

NamedStructure named(const test::Solid& solid, const Grid& grid) { return {solid.name, test::mask_of(solid, grid), {}}; }

Mask derived(const std::string& expression, const std::vector<NamedStructure>& structures, const Image* image = nullptr) {
    return derive(std::vector{"X = " + expression}, structures, {.image = image}, {.threads = 2}).front().mask;
}

std::int64_t count(const Mask& mask) { return std::count(mask.values.begin(), mask.values.end(), 1); }

bool contains(const Mask& a, const Mask& b) {
    for (std::size_t n = 0; n < a.values.size(); ++n)
        if (b.values[n] && !a.values[n]) return false;
    return true;
}

/// Blobs of random balls, some thinner than a voxel.
Mask random_blobs(const Grid& grid, std::mt19937& random) {
    std::uniform_real_distribution<double> place(-14, 14), radius(0.4, 7);
    std::vector<std::pair<Vec3, double>> balls;
    for (int n = 0; n < 12; ++n) balls.push_back({{place(random), place(random), place(random)}, radius(random)});
    return test::mask_of({"",
                          [&](const Vec3& p) {
                              double most = -1e9;
                              for (const auto& [c, r] : balls) most = std::max(most, r - distance(p, c));
                              return most;
                          },
                          {}},
                         grid);
}

TEST(Derive, ANameAloneIsTheStructureVoxelForVoxel) {
    std::mt19937 random = test::random_of_this_test();
    for (const Vec3& spacing : test::spacings())
        for (const double tilt : test::tilts()) {
            const Grid grid = test::grid_of(spacing, tilt, 20);
            const Mask mask = random_blobs(grid, random);
            EXPECT_EQ(derived("A", {{"A", mask, {}}}).values, mask.values);
            EXPECT_EQ(derived("A | A & A", {{"A", mask, {}}}).values, mask.values);
            EXPECT_EQ(count(derived("A - A", {{"A", mask, {}}})), 0);
        }
}

TEST(Derive, ClosingContainsAndOpeningIsContained) {
    std::mt19937 random = test::random_of_this_test();
    for (int round = 0; round < 2; ++round)
        for (const Vec3& spacing : {Vec3{1, 1, 1}, Vec3{0.7, 0.7, 5}, Vec3{2, 2, 2}}) {
            const Mask mask = random_blobs(test::grid_of(spacing, 0.17 * round, 20), random);
            const std::vector<NamedStructure> structures{{"A", mask, {}}};
            for (const char* length : {"0.3 mm", "2 mm", "5 mm"}) {
                const std::string text = length;
                EXPECT_TRUE(contains(derived("(A + " + text + ") - " + text, structures), mask)) << text;
                EXPECT_TRUE(contains(mask, derived("(A - " + text + ") + " + text, structures))) << text;
                EXPECT_TRUE(contains(derived("A + " + text, structures), mask));
                EXPECT_TRUE(contains(mask, derived("A - " + text, structures)));
            }
        }
}

TEST(Derive, ClosingClosesOnlyWhatItMust) {
    // Two balls 6 mm apart: a gap of 10 mm across closes, and nothing beside their common hull.
    const Grid grid = test::grid_of({1, 1, 1}, 0, 26);
    const Vec3 a{-10, 0, 0}, b{10, 0, 0};
    const test::Solid both{"A", [=](const Vec3& p) { return 7 - std::min(distance(p, a), distance(p, b)); }, {}};
    const Mask closed = derived("(A + 5 mm) - 5 mm", {named(both, grid)});
    const Mask mask = test::mask_of(both, grid);
    EXPECT_GT(count(closed), count(mask));
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                if (!closed.values[grid.offset(i, j, k)] || mask.values[grid.offset(i, j, k)]) continue;
                EXPECT_LT(std::abs(p.x), 9) << "beside the gap";
                EXPECT_LT(std::hypot(p.y, p.z), 7);
            }
}

TEST(Derive, ACropLeavesAGap) {
    const Grid grid = test::grid_of({1, 1, 2}, 0.17, 24);
    const test::Solid inner = test::ball(10);
    test::Solid body{"body", [](const Vec3& p) { return 14 - distance(p, {6, 0, 0}); }, {}};
    std::vector<NamedStructure> structures{named(inner, grid), named(body, grid)};
    const Mask cropped = derived("crop(ball, body, 3 mm)", structures),
               kept = derived("avoid(ball, body, 3 mm)", structures);
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                const std::size_t n = grid.offset(i, j, k);
                const double from_ball = inner.level(p), from_body = body.level(p);
                if (std::abs(from_ball) < 1.1) continue;
                if (std::abs(from_body - 3) > 1.1) {
                    EXPECT_EQ(cropped.values[n], from_ball > 0 && from_body > 3);
                }
                if (std::abs(from_body + 3) > 1.1) {
                    EXPECT_EQ(kept.values[n], from_ball > 0 && from_body < -3);
                }
            }
}

TEST(Derive, FillsHolesKeepsTheLargestAndDropsSmallParts) {
    const Grid grid = test::grid_of({1, 1, 1}, 0, 26);
    const auto level = [](const Vec3& p) {
        return std::max({std::min(10 - norm(p), norm(p) - 4), 4 - distance(p, {18, 0, 0}), 2 - distance(p, {-18, 0, 0})});
    };
    const std::vector<NamedStructure> structures{named({"A", level, {}}, grid)};
    const auto ball = [&](const Vec3& c, double r) {
        return count(test::mask_of({"", [=](const Vec3& p) { return r - distance(p, c); }, {}}, grid));
    };
    const std::int64_t hole =
        count(test::mask_of({"", [](const Vec3& p) { return norm(p) < 4    ? 1.0
                                                            : norm(p) == 4 ? 1.0
                                                                           : -1.0; }, {}}, grid));
    const std::int64_t all = count(structures[0].mask), large = ball({18, 0, 0}, 4), small = ball({-18, 0, 0}, 2);
    EXPECT_EQ(count(derived("fill(A)", structures)), all + hole);
    EXPECT_EQ(count(derived("largest(A)", structures)), all - large - small);
    EXPECT_EQ(count(derived("drop(A, 0.1 ml)", structures)), all - small);
    EXPECT_EQ(count(derived("drop(A, 100 ml)", structures)), 0);
}

TEST(Derive, ClipsByAPlane) {
    const Grid grid = test::grid_of({1, 1, 2}, 0.5, 16);
    const std::vector<NamedStructure> structures{named(test::ball(10), grid)};
    const auto expect_clip = [&](const std::string& words, const std::function<double(const Vec3&)>& kept) {
        const Mask found = derived("clip(ball, " + words + ")", structures);
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i) {
                    const std::size_t n = grid.offset(i, j, k);
                    const double side = kept(grid.center_mm(i, j, k));
                    if (std::abs(side) > 1e-3) {
                        EXPECT_EQ(found.values[n], structures[0].mask.values[n] && side > 0) << words;
                    }
                }
    };
    expect_clip("superior 2.5 mm", [](const Vec3& p) { return p.z - 2.5; });
    expect_clip("inferior -1 mm", [](const Vec3& p) { return -1 - p.z; });
    expect_clip("left 3 mm", [](const Vec3& p) { return p.x - 3; });
    expect_clip("anterior 0 mm", [](const Vec3& p) { return -p.y; });
    expect_clip("(1, 2, 3), (1, 1, 0)", [](const Vec3& p) { return (p.x - 1 + p.y - 2) / std::sqrt(2.0); });
}

TEST(Derive, AlongADirectionItIsWhatTheStructurePasses) {
    for (const double tilt : test::tilts()) {
        const Grid grid = test::grid_of({1, 1, 1.5}, tilt, 26);
        const std::vector<NamedStructure> structures{named(test::ball(7), grid)};
        const Mask found = derived("ball + 12 mm along (0, 1, 1)", structures);
        const Vec3 end = 12 * normalized({0, 1, 1});
        for (std::int64_t k = 0; k < grid.size.k; ++k)
            for (std::int64_t j = 0; j < grid.size.j; ++j)
                for (std::int64_t i = 0; i < grid.size.i; ++i) {
                    const Vec3 p = grid.center_mm(i, j, k);
                    const double exact = 7 - distance_to_segment(p, {}, end);
                    if (std::abs(exact) > 0.5) {
                        EXPECT_EQ(found.values[grid.offset(i, j, k)], exact > 0);
                    }
                }
    }
}

TEST(Derive, FindsTheBodyWithoutItsCouch) {
    const Grid grid = test::grid_of({2, 2, 3}, 0, 70);
    std::vector<std::int16_t> values;
    const auto is_body = [](const Vec3& p) { return std::hypot(p.x / 50, p.y / 35) < 1; };
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                const bool lung = std::hypot(p.x - 15, p.y)<12, couch = p.y> 35.5 && p.y < 40;
                values.push_back(lung ? -800 : is_body(p) ? 30 : couch ? 100 : -1000);
            }
    const Image image{grid, values};
    const Mask body = derived("body()", {}, &image);
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                // Where the couch touches the body, up to half the width of a neck of it stays.
                if (std::abs(std::hypot(p.x / 50, p.y / 35) - 1) < (p.y > 30 ? 0.2 : 0.08)) continue;
                EXPECT_EQ(body.values[grid.offset(i, j, k)], is_body(p)) << p.x << ' ' << p.y << ' ' << p.z;
            }
    EXPECT_THROW(derived("body(3000)", {}, &image), Error);
}

/// Circles of a ball on some of the slices.
ContourSet drawn_ball(double radius) {
    ContourSet set;
    set.name = "ball";
    for (const double z : {-12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0}) {
        Contour contour{.plane = make_plane({0, 0, z}, {0, 0, 1}), .points = {}};
        const double r = std::sqrt(radius * radius - z * z);
        for (int n = 0; n < 60; ++n) contour.points.push_back({r * std::cos(n * M_PI / 30), r * std::sin(n * M_PI / 30), z});
        set.contours.push_back(contour);
    }
    return set;
}

TEST(Derive, OfContoursMeasuresFromTheirFunction) {
    Grid grid{{71, 71, 13}, {}};
    grid.index_to_mm.set_column(0, {0.7, 0, 0});
    grid.index_to_mm.set_column(1, {0, 0.7, 0});
    grid.index_to_mm.set_column(2, {0, 0, 5});
    grid.index_to_mm.translation = {-24.5, -24.4, -30};
    const Segmentation drawn = segment(drawn_ball(14), grid, SegmentOptions{}, {.threads = 2});
    const DerivedStructure made =
        derive(std::vector<std::string>{"PTV = ball + 5 mm"},
               std::vector<NamedStructure>{{"ball", drawn.mask, drawn.function}}, {}, {.threads = 2})
            .front();
    EXPECT_EQ(made.name, "PTV");
    EXPECT_EQ(made.sources, std::vector<std::string>{"ball"});
    EXPECT_EQ(made.outlines.name, "PTV");
    // A third of a voxel, and what the fit itself is wrong.
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                const Vec3 n = normalized(p);
                const double length = norm({0.7 * n.x, 0.7 * n.y, 5 * n.z}), exact = 19 - norm(p);
                if (std::abs(exact) > 0.3 * length) {
                    EXPECT_EQ(made.mask.values[grid.offset(i, j, k)], exact > 0) << p.x << ' ' << p.y << ' ' << p.z;
                }
            }
}

TEST(Derive, OutlinesEncloseTheMasksCentres) {
    std::mt19937 random = test::random_of_this_test();
    for (const Vec3& spacing : test::spacings()) {
        const Grid grid = test::grid_of(spacing, 0.17, 20);
        const std::vector<NamedStructure> structures{{"A", random_blobs(grid, random), {}}};
        const DerivedStructure made = derive(std::vector<std::string>{"B = A + 2 mm"}, structures).front();
        EXPECT_EQ(rasterize(made.outlines, grid).values, made.mask.values);
    }
}

TEST(Derive, IsTheSameForAnyNumberOfThreadsAndOrderOfRules) {
    std::mt19937 random = test::random_of_this_test();
    const Grid grid = test::grid_of({1, 1, 3}, 0.17, 24);
    const std::vector<NamedStructure> structures{{"A", random_blobs(grid, random), {}},
                                                 {"B", random_blobs(grid, random), {}}};
    const std::vector<std::string> rules{"Q = P - (B + {1 mm, left 3 mm})", "P = A + 4 mm"}, turned{rules[1], rules[0]};
    const auto one = derive(rules, structures, {}, {.threads = 1}), many = derive(turned, structures, {}, {.threads = 5});
    EXPECT_GT(count(one[0].mask), 0);
    EXPECT_EQ(one[0].mask.values, many[1].mask.values);
    EXPECT_EQ(one[1].mask.values, many[0].mask.values);
}

TEST(Derive, TakesABodyThatIsKnownAndMakesSurfacesWhereTheyAreWanted) {
    const Grid grid = test::grid_of({1, 1, 2}, 0.17, 30);
    const auto body = std::make_shared<const Mask>(test::mask_of(test::ball(12), grid));
    const std::vector<NamedStructure> structures{{"A", test::mask_of(test::ball(5), grid), {}}};
    const std::vector<std::string> rules{"In = crop(A + 9 mm, body(), 2 mm)", "Rest = body() - In", "None = A - A"};
    int asked = 0;
    const FindBody find = [&](const std::optional<double>&) { return ++asked, body; };
    const auto made = derive(rules, structures, {.body = find, .mesh = true});
    EXPECT_EQ(asked, 2);
    for (const DerivedStructure& one : made) {
        EXPECT_TRUE(contains(*body, one.mask)) << one.rule;
        const double ml = static_cast<double>(count(one.mask)) * grid.voxel_volume_mm3() / 1000;
        EXPECT_NEAR(signed_volume_mm3(one.mesh) / 1000, ml, 0.08 * ml) << one.rule << ", 2 voxels thick in places";
        EXPECT_EQ(one.mesh.triangles.empty(), one.name == "None");
        EXPECT_TRUE(one.mesh.triangles.empty() || (topology(one.mesh).closed && topology(one.mesh).oriented)) << one.rule;
    }
    for (const DerivedStructure& one : derive(rules, structures, {.body = find})) EXPECT_TRUE(one.mesh.triangles.empty());
}

TEST(Derive, RefusesStructuresThatDoNotFit) {
    const Grid grid = test::grid_of({1, 1, 1}, 0, 8), other = test::grid_of({1, 1, 1.2}, 0, 8);
    const NamedStructure a{"A", test::mask_of(test::ball(5), grid), {}}, b{"B", test::mask_of(test::ball(5), other), {}};
    const std::vector<std::string> rules{"X = A"};
    EXPECT_THROW(derive(rules, std::vector{a, b}), Error);
    EXPECT_THROW(derive(rules, std::vector{a, a}), Error);
    EXPECT_THROW(derive(rules, {}), Error);
    EXPECT_TRUE(derive(std::vector<std::string>{}, std::vector{a}).empty());
}

}  // namespace
}  // namespace kontur
