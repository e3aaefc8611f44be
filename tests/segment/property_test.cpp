// SPDX-License-Identifier: Apache-2.0
// What must hold for any drawing: random bodies cut by random planes, drawn well or badly. CONTRIBUTING.md says how to run
// many.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "kontur/phantom/drawing.h"
#include "kontur/segment.h"
#include "support/functions.h"

namespace kontur {
namespace {

/// How a drawing was made, and what may be expected of it.
struct Drawing {
    std::string what;
    ContourSet contours;
    double body_mm3 = 0;
    double least = 0, most = 1.4;  ///< bounds of the mask's volume as fractions of the body's
    double residual = 0.01;  ///< bound of the surface's distance from the drawn points, as a fraction of the set's diagonal
};

double volume_mm3(const Body& body) {
    const Grid grid = grid_around(body.bounds(), {3, 3, 3}, 0);
    double voxels = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) voxels += body.value(grid.center_mm(i, j, k)) > 0;
    return voxels * grid.voxel_volume_mm3();
}

class Artist {
public:
    explicit Artist(unsigned seed) : random_(seed) {}

    Drawing draw() {
        Drawing drawing;
        const Body body = random_body(drawing);
        drawing.body_mm3 = volume_mm3(body);
        drawing.contours = draw_sections(body, random_planes(drawing), 300);
        damage(drawing);
        scale(drawing);
        return drawing;
    }

private:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    Vec3 direction() {
        std::normal_distribution<double> normal;
        return normalized({normal(random_), normal(random_), normal(random_)});
    }

    /// An ellipsoid, bent or with a second one grown to it, and waves on its surface.
    Body random_body(Drawing& drawing) {
        const Vec3 half{between(20, 60), between(20, 60), between(20, 60)};
        const Vec3 wave = between(0, 0.15) * direction() / 10;
        const double bend = below(2) * between(0, 0.005), waviness = below(2) * between(0, 0.06);
        const double least = std::min({half.x, half.y, half.z});
        drawing.what = "body of " + std::to_string(half.x) + " x " + std::to_string(half.y) + " x " + std::to_string(half.z);
        const auto value = [=](const Vec3& p) {
            const double y = p.y - bend * p.x * p.x;
            const double radius =
                std::sqrt(p.x * p.x / (half.x * half.x) + y * y / (half.y * half.y) + p.z * p.z / (half.z * half.z));
            return least * (1 + waviness * std::sin(20 * dot(wave, p)) - radius);
        };
        return {"body", Box3{{-70, -70, -70}, {70, 90, 70}}, value};
    }

    std::vector<Plane> random_planes(Drawing& drawing) {
        std::vector<Plane> planes;
        switch (below(6)) {
            case 0: {  // parallel
                const Vec3 normal = direction();
                const int count = 5 + below(5);
                for (int i = 0; i < count; ++i)
                    planes.push_back(make_plane((i + 0.5 - count / 2.0) * (36.0 / count) * normal, normal));
                drawing.what += ", parallel planes";
                drawing.least = 0.3;
                break;
            }
            case 1:  // two or three in each main direction
                for (int axis = 0; axis < 3; ++axis)
                    for (int i = 0; i < 3; ++i) {
                        Vec3 normal{}, origin{};
                        normal[axis] = 1;
                        origin[axis] = 9.0 * (i - 1) + between(-2, 2);
                        planes.push_back(make_plane(origin, normal));
                    }
                drawing.what += ", orthogonal planes";
                drawing.least = 0.6;
                break;
            case 2:  // random ones near the middle
                for (int i = 0; i < 7; ++i) planes.push_back(make_plane(between(-10, 10) * direction(), direction()));
                drawing.what += ", oblique planes";
                drawing.least = 0.5;
                break;
            case 3: {  // two or three parallel ones, or a sweep by hand, each tilted a little against the others
                const Vec3 normal = direction();
                const double tilt = below(2) * between(0, 0.4);
                const int count = tilt > 0 ? 3 + below(6) : 2 + below(2);
                for (int i = 0; i < count; ++i)
                    planes.push_back(make_plane((i + 0.5 - count / 2.0) * (36.0 / count) * normal,
                                                normalized(normal + tilt * between(0, 1) * direction())));
                drawing.what += ", " + std::to_string(count) + " planes tilted by up to " + std::to_string(tilt);
                drawing.least = 0.2;
                drawing.most = 2;
                break;
            }
            case 4: {  // two that cross at a small angle
                const Vec3 normal = direction();
                planes = {make_plane({}, normal), make_plane({}, normalized(normal + between(0.05, 0.8) * direction()))};
                drawing.what += ", two planes that cross";
                drawing.least = 0.02;
                drawing.most = 8;
                break;
            }
            default:  // a single one, or two that cross
                for (int i = 0; i < 1 + below(2); ++i) planes.push_back(make_plane({}, direction()));
                drawing.what += ", " + std::to_string(planes.size()) + " plane(s)";
                drawing.least = 0.02;
                drawing.most = 8;
        }
        return planes;
    }

    Contour& any_contour(Drawing& drawing) {
        return drawing.contours
            .contours[static_cast<std::size_t>(below(static_cast<int>(drawing.contours.contours.size())))];
    }

    void damage(Drawing& drawing) {
        switch (below(5)) {
            case 0: {  // every point off by up to 0.4 mm
                for (Contour& contour : drawing.contours.contours)
                    for (Vec3& p : contour.points)
                        p += between(-0.4, 0.4) * contour.plane.u + between(-0.4, 0.4) * contour.plane.v;
                drawing.what += ", jitter";
                drawing.residual = 0.03;
                break;
            }
            case 1: {  // each contour a little shifted, so that they contradict each other
                for (Contour& contour : drawing.contours.contours) {
                    const Vec3 shift = between(-1, 1) * contour.plane.u + between(-1, 1) * contour.plane.v;
                    for (Vec3& p : contour.points) p += shift;
                }
                drawing.what += ", shifted";
                drawing.residual = 0.05;
                break;
            }
            case 2: {  // a stretch of one contour drawn backwards: it crosses itself twice
                std::vector<Vec3>& points = any_contour(drawing).points;
                const auto first = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 4);
                std::reverse(first, first + static_cast<std::ptrdiff_t>(points.size() / 6));
                drawing.what += ", crossing itself";
                drawing.least *= 0.3;
                drawing.residual = 0.2;  // the two strokes of the tangle are not one surface
                break;
            }
            case 3: {  // a fifth of one contour missing
                std::vector<Vec3>& points = any_contour(drawing).points;
                points.erase(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(points.size() / 5));
                drawing.what += ", part missing";
                drawing.least *= 0.5;
                drawing.residual = 0.1;
                break;
            }
            default:
                break;
        }
    }

    void scale(Drawing& drawing) {
        const double factor = std::pow(10.0, between(-3, 3));
        for (Contour& contour : drawing.contours.contours) {
            for (Vec3& p : contour.points) p *= factor;
            contour.plane.origin *= factor;
        }
        drawing.body_mm3 *= factor * factor * factor;
        drawing.what += ", scaled by " + std::to_string(factor);
    }

    std::mt19937 random_;
};

void check(const Drawing& drawing) {
    const Box3 box = bounding_box(drawing.contours);
    const double diagonal = box.diagonal();
    const Grid grid = grid_around(box, Vec3{1, 1, 1} * (diagonal / 50), 0.6 * diagonal);
    const Segmentation result = segment(drawing.contours, grid, {.mesh = true});
    EXPECT_TRUE(is_finite({result.report.residual.max_mm, result.report.residual.rms_mm, result.report.mask_volume_ml}));
    EXPECT_LE(result.report.residual.max_mm, drawing.residual * diagonal);
    for (const std::string& warning : result.report.warnings)
        EXPECT_EQ(warning.find("border"), std::string::npos) << "a leak: " << warning;
    const double drawn = 1000 * result.report.mask_volume_ml / drawing.body_mm3;
    EXPECT_GE(drawn, drawing.least);
    EXPECT_LE(drawn, drawing.most);
    const MeshTopology shape = topology(*result.mesh);
    EXPECT_TRUE(shape.closed);
    EXPECT_TRUE(shape.oriented);
}

unsigned from_environment(const char* name, unsigned otherwise) {
    const char* text = std::getenv(name);
    return text && *text ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

TEST(Properties, NoDrawingCrashesLeaksOrOpensItsSurface) {
    const unsigned first = from_environment("KONTUR_PROPERTY_SEED", 1),
                   rounds = from_environment("KONTUR_PROPERTY_ROUNDS", 60);
    for (unsigned seed = first; seed < first + rounds; ++seed) {
        const Drawing drawing = Artist(seed).draw();
        SCOPED_TRACE("KONTUR_PROPERTY_SEED=" + std::to_string(seed) + " KONTUR_PROPERTY_ROUNDS=1: " + drawing.what);
        try {
            check(drawing);
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

}  // namespace
}  // namespace kontur
