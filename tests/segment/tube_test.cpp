// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "kontur/segment.h"
#include "support/contour_sets.h"

namespace kontur {
namespace {

/// A tube of that radius about a curve over [0, 1], drawn by rings at even steps.
struct Tube {
    std::string name;
    double radius;
    int rings;
    double dice;  ///< at least, between the first and the last ring
    std::function<Vec3(double)> at;
    double tilt = 0;  ///< of the first ring and, the other way, of the last one: radians about y
};

Vec3 direction(const Tube& tube, double t) { return normalized(tube.at(t + 1e-4) - tube.at(t - 1e-4)); }

ContourSet drawn(const Tube& tube) {
    ContourSet set;
    for (int n = 0; n < tube.rings; ++n) {
        const double t = n / (tube.rings - 1.0);
        const double tilt = n == 0 ? tube.tilt : n == tube.rings - 1 ? -tube.tilt : 0;
        const Vec3 along = direction(tube, t);
        const Vec3 normal = std::cos(tilt) * along + std::sin(tilt) * cross(along, {0, 1, 0});
        set.contours.push_back(test::circle(make_plane(tube.at(t), normal), tube.radius, 32));
    }
    return set;
}

double dice_between_rings(const Tube& tube) {
    constexpr int kSteps = 200;
    const ContourSet set = drawn(tube);
    const ImplicitFunction function = segment(set, grid_around(bounding_box(set), {4, 4, 4}, 10)).function;
    std::vector<Vec3> curve;
    for (int n = 0; n <= kSteps; ++n) curve.push_back(tube.at(n / static_cast<double>(kSteps)));
    const Box3 box = bounding_box(set);
    const double step = tube.radius / 6;
    std::vector<Vec3> places;
    std::vector<bool> is_in;
    for (double z = box.min.z - tube.radius; z < box.max.z + tube.radius; z += step)
        for (double y = box.min.y - tube.radius; y < box.max.y + tube.radius; y += step)
            for (double x = box.min.x - tube.radius; x < box.max.x + tube.radius; x += step) {
                const auto squared = [&](const Vec3& p) { return dot(p - Vec3{x, y, z}, p - Vec3{x, y, z}); };
                const auto nearest = std::ranges::min_element(curve, {}, squared);
                const double away = std::sqrt(squared(*nearest));
                if (nearest == curve.begin() || nearest == curve.end() - 1 || away > 2 * tube.radius) continue;
                places.push_back({x, y, z});
                is_in.push_back(away < tube.radius);
            }
    std::vector<double> values(places.size());
    function.values(places, values);
    int truth = 0, found = 0, both = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        truth += is_in[i];
        found += values[i] > 0;
        both += is_in[i] && values[i] > 0;
    }
    return 2.0 * both / (truth + found);
}

Vec3 half_turn(double t) { return {60 * std::cos(M_PI * t), 0, 60 * std::sin(M_PI * t)}; }

class TubeByRings : public testing::TestWithParam<Tube> {};

TEST_P(TubeByRings, GoesOnBetweenThem) { EXPECT_GT(dice_between_rings(GetParam()), GetParam().dice); }

INSTANTIATE_TEST_SUITE_P(
    Tubes, TubeByRings,
    testing::Values(Tube{"Straight6RadiiApart", 5, 6, 0.94,
                         [](double t) {
                             return Vec3{0, 0, 165 * t};
                         }},
                    Tube{"Straight5RadiiApart", 5, 8, 0.96,
                         [](double t) {
                             return Vec3{0, 0, 175 * t};
                         }},
                    Tube{"Arch", 5, 6, 0.95,
                         [](double t) {
                             return Vec3{40 * std::cos(M_PI * t), 0, 40 * std::sin(M_PI * t)};
                         }},
                    // Without its walls' bounds its ends are a sixth too wide: .926.
                    Tube{"Arch3RadiiApart", 6, 6, 0.96,
                         [](double t) {
                             return Vec3{39 * std::cos(2.3 * t), 0, 39 * std::sin(2.3 * t)};
                         }},
                    // Each foot's plane says that nothing is there close beside the other foot.
                    Tube{"ArchOfNearlyOnePlane", 8, 6, 0.95, half_turn, 1e-3},
                    Tube{"ArchOfPlanesALittleTilted", 8, 6, 0.94, half_turn, 1e-2},
                    Tube{"S", 5, 8, 0.95,
                         [](double t) {
                             return Vec3{20 * std::sin(6 * t), 0, 180 * t};
                         }},
                    Tube{"Helix", 4, 19, 0.94,
                         [](double t) {
                             return Vec3{25 * std::cos(4 * M_PI * t), 25 * std::sin(4 * M_PI * t), 60 * t};
                         }},
                    // Each ring's plane cuts the next turn between two of its rings, 60 degrees apart.
                    Tube{"Helix6RadiiApart", 4, 13, 0.93,
                         [](double t) {
                             return Vec3{25 * std::cos(4 * M_PI * t), 25 * std::sin(4 * M_PI * t), 60 * t};
                         }},
                    // The next turn lies 6 radii away: nearer than the next ring, 6.5 radii. Taken as looked at there: .84.
                    Tube{"HelixOfCloseTurns", 5, 13, 0.93,
                         [](double t) {
                             return Vec3{37 * std::cos(10.5 * t), 37 * std::sin(10.5 * t), 51 * t};
                         }}),
    [](const auto& info) { return info.param.name; });

/// Four rings of 8 mm, 37 mm apart, and planes so far beyond both ends that show nothing.
class TubeWithEmptyPlanes : public testing::TestWithParam<double> {};

TEST_P(TubeWithEmptyPlanes, EndsThereWithoutAClub) {
    constexpr double kRadius = 8, kGap = 37;
    ContourSet set;
    for (int n = 0; n < 4; ++n) set.contours.push_back(test::circle(make_plane({0, 0, n * kGap}, {0, 0, 1}), kRadius, 48));
    set.empty_planes = {make_plane({0, 0, -GetParam()}, {0, 0, 1}), make_plane({0, 0, 3 * kGap + GetParam()}, {0, 0, 1})};
    const Segmentation made = segment(set, grid_around(bounding_box(set), {1, 1, 1}, 20));
    const double drawn_ml = M_PI * kRadius * kRadius * 3 * kGap / 1000;
    EXPECT_GT(made.report.mask_volume_ml, 0.97 * drawn_ml);
    EXPECT_LT(made.report.mask_volume_ml, 1.15 * drawn_ml) << "without the walls' bounds 1.4 to 1.8 times";
}

INSTANTIATE_TEST_SUITE_P(Distances, TubeWithEmptyPlanes, testing::Values(0.7, 1, 2, 4, 8));

}  // namespace
}  // namespace kontur
