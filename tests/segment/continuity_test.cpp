// SPDX-License-Identifier: Apache-2.0
// A hand that drags a plane must not see the object leap: volumes of sections of one ellipsoid, drawn in planes that turn
// and move by small steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kontur/segment.h"
#include "kontur/shape/mesh.h"

namespace kontur {
namespace {

constexpr Vec3 kSemiAxes{40, 33, 26.8};
constexpr double kTruth_ml = 4.0 / 3 * std::numbers::pi * kSemiAxes.x * kSemiAxes.y * kSemiAxes.z / 1000;

/// Where a plane cuts the ellipsoid. With x = s u, s the semi-axes, it is the unit ball.
Contour section(const Vec3& origin, const Vec3& normal) {
    constexpr int kPoints = 60;
    const auto [u, v] = [&] {
        const Vec3 beside = std::abs(normal.y) < 0.8 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
        const Vec3 first = normalized(cross(normal, beside));
        return std::pair(first, cross(normal, first));
    }();
    const auto product = [](const Vec3& a, const Vec3& b) {
        return a.x * b.x / (kSemiAxes.x * kSemiAxes.x) + a.y * b.y / (kSemiAxes.y * kSemiAxes.y) +
               a.z * b.z / (kSemiAxes.z * kSemiAxes.z);
    };
    const double uu = product(u, u), uv = product(u, v), vv = product(v, v), ou = product(origin, u),
                 ov = product(origin, v);
    const double determinant = uu * vv - uv * uv;
    const Vec3 center = origin + (-ou * vv + ov * uv) / determinant * u + (-ov * uu + ou * uv) / determinant * v;
    Contour contour;
    contour.plane = make_plane(center, normal);
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2 * std::numbers::pi * i / kPoints;
        const Vec3 direction = std::cos(angle) * u + std::sin(angle) * v;
        contour.points.push_back(center +
                                 std::sqrt((1 - product(center, center)) / product(direction, direction)) * direction);
    }
    return contour;
}

Vec3 tilted(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::sin(angle), 0, std::cos(angle)};
}

double volume_ml(const ContourSet& contours) {
    constexpr double kHalf = 126, kSpacing = 4;  // three radii of the object: what runs farther counts, too
    constexpr auto kSize = static_cast<std::int64_t>(2 * kHalf / kSpacing);
    Grid grid;
    grid.size = {kSize, kSize, kSize};
    for (int axis = 0; axis < 3; ++axis) grid.index_to_mm.linear[axis][axis] = kSpacing;
    grid.index_to_mm.translation = Vec3{-kHalf, -kHalf, -kHalf} + Vec3{kSpacing, kSpacing, kSpacing} / 2;
    return std::abs(signed_volume_mm3(*segment(contours, grid, {.mesh = true}).mesh)) / 1000;
}

struct Sweep {
    double least_ml = 1e300, most_ml = 0;
    double worst_step = 0, worst_at = 0;  ///< relative to the volume
};

Sweep sweep(double from, double to, double step, const std::function<ContourSet(double)>& drawing) {
    Sweep result;
    double last = 0;
    for (int n = 0; from + n * step <= to; ++n) {
        const double at = from + n * step, volume = volume_ml(drawing(at));
        result.least_ml = std::min(result.least_ml, volume);
        result.most_ml = std::max(result.most_ml, volume);
        if (const double change = std::abs(volume - last) / volume; last > 0 && change > result.worst_step) {
            result.worst_step = change;
            result.worst_at = at;
        }
        last = volume;
    }
    testing::Test::RecordProperty("worst_step_percent", std::to_string(100 * result.worst_step));
    testing::Test::RecordProperty("worst_at", std::to_string(result.worst_at));
    testing::Test::RecordProperty("range_ml", std::to_string(result.least_ml) + " to " + std::to_string(result.most_ml));
    return result;
}

ContourSet sections(std::initializer_list<double> heights) {
    ContourSet set;
    for (const double z : heights) set.contours.push_back(section({0, 0, z}, {0, 0, 1}));
    return set;
}

ContourSet with_one_more(ContourSet set, const Vec3& origin, const Vec3& normal) {
    set.contours.push_back(section(origin, normal));
    return set;
}

// 2 % of the size is 1.6 mm, and along an arc of the long axis 2.3 degrees.

TEST(Continuity, VolumeChangesLittleWithTheAngleOfOneOfTwoPlanes) {
    const Sweep turned = sweep(0, 90, 2, [](double degrees) { return with_one_more(sections({0}), {}, tilted(degrees)); });
    EXPECT_LT(turned.worst_step, 0.025) << "at " << turned.worst_at << " degrees";
    // As thick as a section of 40 x 33 mm is wide, which real organs are in the median; this ellipsoid is thinner.
    EXPECT_LT(turned.most_ml, 36.3 / kSemiAxes.z * 1.06 * kTruth_ml) << "what planes at a small angle leave open";
    EXPECT_GT(turned.least_ml, kTruth_ml);
}

TEST(Continuity, VolumeChangesLittleWithTheAngleOfOneOfFivePlanes) {
    const Sweep turned = sweep(0, 90, 2, [](double degrees) {
        return with_one_more(sections({-18, -6, 6, 18}), {}, tilted(degrees));
    });
    EXPECT_LT(turned.worst_step, 0.02) << "at " << turned.worst_at << " degrees";
}

TEST(Continuity, VolumeChangesLittleWithTheDistanceOfTwoPlanes) {
    const Sweep apart = sweep(0.1, 32, 1.0, [](double mm) { return sections({-mm / 2, mm / 2}); });
    EXPECT_LT(apart.worst_step, 0.02) << "at " << apart.worst_at << " mm";
}

TEST(Continuity, VolumeChangesLittleWithTheDistanceOfAThirdPlane) {
    const Sweep apart = sweep(0.1, 24, 0.8, [](double mm) { return sections({-13, 0, mm}); });
    EXPECT_LT(apart.worst_step, 0.02) << "at " << apart.worst_at << " mm";
}

TEST(Continuity, VolumeChangesLittleWithTheDistanceOfALastPlane) {
    const Sweep apart = sweep(0.1, 14, 0.8, [](double mm) { return sections({-20, -12, -4, 4, 12, 12 + mm}); });
    EXPECT_LT(apart.worst_step, 0.02) << "at " << apart.worst_at << " mm";
}

/// Scaled about its centre.
Contour scaled(Contour contour, double factor) {
    Vec3 center;
    for (const Vec3& p : contour.points) center += p / static_cast<double>(contour.points.size());
    for (Vec3& p : contour.points) p = center + factor * (p - center);
    return contour;
}

/// Down to a fortieth. Where it is taken away, nothing says any more that the rest of its plane is empty: that is a step.
TEST(Continuity, VolumeChangesLittleAsTheLastContourShrinks) {
    const auto drawing = [](double gone) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.contours.back() = scaled(set.contours.back(), 1 - gone);
        return set;
    };
    const Sweep shrunk = sweep(0, 0.976, 0.025, drawing);
    EXPECT_LT(shrunk.worst_step, 0.02) << "at " << shrunk.worst_at;
}

TEST(Continuity, VolumeChangesLittleAsAHoleShrinksToNothing) {
    const auto drawing = [](double gone) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        if (gone < 1) {
            set.contours.push_back(scaled(set.contours[2], 0.4 * (1 - gone)));
            set.contours.back().hole = true;
        }
        return set;
    };
    const Sweep shrunk = sweep(0, 1, 0.05, drawing);
    EXPECT_LT(shrunk.worst_step, 0.02) << "at " << shrunk.worst_at;
}

TEST(Continuity, VolumeChangesLittleAsAContourLosesItsWeight) {
    const auto drawing = [](double lost) {  // a contradiction: much smaller than those beside it
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.contours[2] = scaled(set.contours[2], 0.8);
        set.contours[2].weight = std::pow(10, -lost);
        return set;
    };
    const Sweep lighter = sweep(0, 2, 0.1, drawing);
    EXPECT_LT(lighter.worst_step, 0.02) << "at 10^-" << lighter.worst_at;
}

TEST(Continuity, VolumeChangesLittleAsAContourGainsWeight) {
    const auto drawing = [](double gained) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.contours[2] = scaled(set.contours[2], 0.8);
        set.contours[2].weight = std::pow(10, gained);
        return set;
    };
    const Sweep heavier = sweep(0, 3, 0.1, drawing);
    EXPECT_LT(heavier.worst_step, 0.02) << "at 10^" << heavier.worst_at;
}

/// A second reader's contour, half a mm wider, from a plane to the next one that was drawn.
TEST(Continuity, VolumeChangesLittleAsAPlaneIsDrawnTwice) {
    const double once_ml = volume_ml(sections({-16, -8, 0, 8, 16}));
    const auto drawing = [](double mm) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.contours.push_back(scaled(section({0, 0, mm}, {0, 0, 1}), 1.0125));
        return set;
    };
    const Sweep apart = sweep(0, 8, 0.4, drawing);
    EXPECT_LT(apart.worst_step, 0.02) << "at " << apart.worst_at << " mm";
    EXPECT_GT(apart.least_ml, 0.99 * once_ml);
    EXPECT_LT(apart.most_ml, 1.02 * once_ml);
}

/// The same in the plane itself, ever wider, and moved aside until the lines cross.
TEST(Continuity, VolumeChangesLittleAsALineIsDrawnAgain) {
    const double once_ml = volume_ml(sections({-16, -8, 0, 8, 16}));
    const auto drawn_again = [](double wider_mm, double aside_mm) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.contours.push_back(scaled(set.contours[2], 1 + wider_mm / kSemiAxes.x));
        for (Vec3& p : set.contours.back().points) p.x += aside_mm;
        return set;
    };
    const Sweep wider = sweep(0, 8, 0.5, [&](double mm) { return drawn_again(mm, 0); });
    EXPECT_LT(wider.worst_step, 0.01) << "at " << wider.worst_at << " mm";
    EXPECT_NEAR(wider.least_ml, once_ml, 0.001 * once_ml);
    EXPECT_LT(wider.most_ml, 1.1 * once_ml);
    const Sweep aside = sweep(0, 4, 0.5, [&](double mm) { return drawn_again(0.5, mm); });
    EXPECT_LT(aside.worst_step, 0.002) << "at " << aside.worst_at << " mm";
}

/// As with a brush or a control point: a bulge of a fifth of the outline.
TEST(Continuity, VolumeFollowsABulgeThatIsPulledOutOfAContour) {
    const auto drawing = [](double mm) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        for (Vec3& p : set.contours[2].points) {
            const double away = (std::atan2(p.y, p.x) - 0.9) / 0.35;
            p += mm * std::exp(-away * away) * normalized(p);
        }
        return set;
    };
    const Sweep pulled = sweep(-10, 14, 0.8, drawing);
    EXPECT_LT(pulled.worst_step, 0.01) << "at " << pulled.worst_at << " mm";
}

TEST(Continuity, VolumeFollowsAContourThatIsDraggedInItsPlane) {
    const auto drawing = [](double mm) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        for (Vec3& p : set.contours[2].points) p.x += mm;
        return set;
    };
    const Sweep dragged = sweep(0, 16, 0.8, drawing);
    EXPECT_LT(dragged.worst_step, 0.01) << "at " << dragged.worst_at << " mm";
}

TEST(Continuity, VolumeChangesLittleAsAPointIsDraggedAcrossAContour) {
    const auto drawing = [](double mm) {
        ContourSet set = sections({-16, -8, 0, 8, 16});
        set.surface.push_back({.position = {mm, 0, 0}});
        return set;
    };
    const Sweep dragged = sweep(30, 52, 1.6, drawing);
    EXPECT_LT(dragged.worst_step, 0.02) << "at " << dragged.worst_at << " mm";
}

}  // namespace
}  // namespace kontur
