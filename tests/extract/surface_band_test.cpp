// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/surface_band.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/editor.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "kontur/phantom/cases.h"
#include "kontur/view/outline.h"
#include "support/expect_error.h"
#include "support/functions.h"
#include "support/random.h"

namespace kontur {
namespace {

std::vector<Vec3> circle(const Vec3& center, double radius) {
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i)
        points.push_back(center + radius * Vec3{std::cos(i * M_PI / 20), std::sin(i * M_PI / 20), 0});
    return points;
}

double distance_to_line(const Vec3& p, const std::vector<Vec3>& line) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec3 &a = line[i], along = line[(i + 1) % line.size()] - a;
        const double length2 = dot(along, along);
        const double t = length2 > 0 ? std::clamp(dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, distance(p, a + t * along));
    }
    return nearest;
}

using Lines = std::vector<std::vector<Vec3>>;

/// From each point of `from` to the nearest line of `to`.
void append_distances(const Lines& from, const Lines& to, std::vector<double>& distances) {
    for (const auto& line : from)
        for (const Vec3& p : line) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const auto& other : to) nearest = std::min(nearest, distance_to_line(p, other));
            distances.push_back(nearest);
        }
}

/// The slow and obvious way: a mesh, cut.
Lines cut_of_mesh(const TriangleMesh& mesh, const Plane& plane) {
    Lines lines;
    for (const Polyline& line : outline(mesh, plane)) {
        EXPECT_TRUE(line.closed);
        lines.push_back(line.points);
    }
    return lines;
}

/// Without those smaller than some cells: where a plane grazes the surface, one of the two may miss it.
Lines without_grazed(Lines lines, double spacing_mm) {
    std::erase_if(lines, [&](const auto& line) { return bounding_box(line).diagonal() < 2 * spacing_mm; });
    return lines;
}

TEST(SurfaceBand, CutsABallInACircle) {
    const Vec3 center{20, -30, 1000};
    const SurfaceBand band(test::ball_function(center, 15), circle(center, 15), {.spacing_mm = 0.5});
    for (const double height : {-9.0, 0.0, 12.0}) {
        const Plane plane = make_plane(center + Vec3{0, 0, height}, {0, 0, 1});
        const Lines lines = band.cut(plane);
        ASSERT_EQ(lines.size(), 1u) << height;
        for (const Vec3& p : lines[0]) EXPECT_NEAR(distance(p, center), 15, 0.01);
        EXPECT_GT(lines[0].size(), 60u);
    }
    EXPECT_TRUE(band.cut(make_plane(center + Vec3{0, 0, 16}, {0, 0, 1})).empty());
    EXPECT_TRUE(band.cut(make_plane(center + Vec3{0, 0, 500}, {0, 0, 1})).empty());
}

/// A case's function as a preview has it, and where its surface passes.
struct Surface {
    explicit Surface(const PhantomCase& c)
        : function(Editor({.segment = {}, .preview_spacing_mm = 10}).preview(c.contours).function) {
        for (const Contour& contour : c.contours.contours)
            starts.insert(starts.end(), contour.points.begin(), contour.points.end());
        spacing_mm = 0.01 * diameter_mm(c.contours);
    }

    ImplicitFunction function;
    std::vector<Vec3> starts;
    double spacing_mm = 0;
};

std::vector<Plane> drawn_and_random_planes(const ContourSet& contours, std::mt19937& random) {
    std::normal_distribution<double> direction;
    std::uniform_real_distribution<double> part(-0.4, 0.4);
    const Box3 box = bounding_box(contours);
    std::vector<Plane> planes;
    for (const Contour& contour : contours.contours) planes.push_back(contour.plane);
    for (int n = 0; n < 20; ++n) {
        const Vec3 size = box.size(), off{part(random) * size.x, part(random) * size.y, part(random) * size.z};
        const Vec3 normal = normalized({direction(random), direction(random), direction(random)});
        planes.push_back(make_plane(box.center() + off, normal));
    }
    return planes;
}

TEST(SurfaceBand, AgreesWithTheMeshOfTheSameSurface) {
    std::mt19937 random = test::random_of_this_test();
    for (const char* name : {"liver_orthogonal14_hand", "kidney_radial6", "metastasis_parallel7_hand"}) {
        const PhantomCase c = phantom_case(name);
        const Surface surface(c);
        const SurfaceBand band(surface.function, surface.starts, {surface.spacing_mm});
        const Grid lattice = *preview_lattice(surface.starts, surface.spacing_mm);
        const TriangleMesh mesh =
            polygonize(track_surface_adaptively(surface.function, lattice, surface.starts), surface.function);
        std::vector<double> distances;
        for (const Plane& plane : drawn_and_random_planes(c.contours, random)) {
            const Lines fast = without_grazed(band.cut(plane), surface.spacing_mm);
            const Lines slow = without_grazed(cut_of_mesh(mesh, plane), surface.spacing_mm);
            EXPECT_EQ(fast.size(), slow.size()) << name;
            append_distances(fast, slow, distances);
            append_distances(slow, fast, distances);
        }
        std::ranges::sort(distances);
        EXPECT_LT(distances[distances.size() * 98 / 100], 0.1 * surface.spacing_mm) << name;
        EXPECT_LT(distances.back(), surface.spacing_mm) << name;
    }
}

TEST(SurfaceBand, NeedsATenthOfTheValuesOfTheMesh) {
    const Surface surface(phantom_case("liver_orthogonal14_hand"));
    const SurfaceBand band(surface.function, surface.starts, {surface.spacing_mm});
    const Grid lattice = *preview_lattice(surface.starts, surface.spacing_mm);
    const SurfaceLattice tracked = track_surface_adaptively(surface.function, lattice, surface.starts, {.threads = 0});
    const TriangleMesh mesh = preview_surface(surface.function, surface.starts, {surface.spacing_mm});
    const auto of_mesh = static_cast<double>(tracked.evaluations) + 3 * static_cast<double>(mesh.normals.size());
    EXPECT_LT(static_cast<double>(band.evaluations()), 0.1 * of_mesh);
}

TEST(SurfaceBand, IgnoresWhatIsNotJoinedToTheStarts) {
    // Two balls: the product's zero level around each, but only one of them was drawn.
    const Vec3 drawn{0, 0, 0}, other{30, 0, 0};
    const SurfaceBand one(test::ball_function(drawn, 8), circle(drawn, 8), {.spacing_mm = 0.5});
    EXPECT_EQ(one.cut(make_plane({}, {0, 0, 1})).size(), 1u);
    EXPECT_TRUE(one.cut(make_plane(other, {1, 0, 0})).empty());
}

TEST(SurfaceBand, CutsALeakOffWhereTheMeshDoes) {
    const ImplicitFunction half_space(Kernel::triharmonic, {{}, 1}, {}, {}, {0, 0, 0, 1});
    const std::vector<Vec3> starts{{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
    const Plane plane = make_plane({0, 0, 0}, {0, 1, 0});
    const Lines lines = SurfaceBand(half_space, starts, {.spacing_mm = 1}).cut(plane);
    const Lines slow = cut_of_mesh(preview_surface(half_space, starts, {.spacing_mm = 1}), plane);
    std::vector<double> distances;
    append_distances(lines, slow, distances);
    ASSERT_FALSE(distances.empty());
    EXPECT_EQ(lines.size(), slow.size());
    EXPECT_LE(*std::ranges::max_element(distances), 1) << "a spacing";
}

TEST(SurfaceBand, WithoutFiniteStartsIsEmpty) {
    const ImplicitFunction ball = test::ball_function({}, 5);
    EXPECT_TRUE(SurfaceBand(ball, {}).cut(make_plane({}, {0, 0, 1})).empty());
    EXPECT_TRUE(SurfaceBand(ball, std::vector<Vec3>{{std::nan(""), 0, 0}}).cut(make_plane({}, {0, 0, 1})).empty());
}

TEST(SurfaceBand, RefusesSpacingsThatMakeNoSense) {
    EXPECT_KONTUR_ERROR(SurfaceBand(test::ball_function({}, 5), std::vector<Vec3>{{5, 0, 0}}, {.spacing_mm = 0}),
                        ErrorKind::invalid_input, "spacing");
}

}  // namespace
}  // namespace kontur
