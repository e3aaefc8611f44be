// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/dense_liver.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/error.h"
#include "kontur/phantom/drawing.h"
#include "kontur/phantom/section_planes.h"

namespace kontur {
namespace {

Body scaled(const Body& body, double factor) {
    return {body.name(), Box3{factor * body.bounds().min, factor * body.bounds().max},
            [body, factor](const Vec3& p) { return factor * body.value(p / factor); }};
}

ContourSet scaled(ContourSet set, double factor) {
    for (Contour& contour : set.contours) {
        contour.plane.origin *= factor;
        for (Vec3& p : contour.points) p *= factor;
    }
    return set;
}

}  // namespace

PhantomCase dense_liver_case(const DenseLiver& options) {
    if (options.points < 100)
        throw Error(ErrorKind::invalid_input, "a liver drawn with " + std::to_string(options.points) +
                                                  " points is too coarse; at least 100 are needed");
    constexpr double kMostUnscaled = 25000;
    const double points = static_cast<double>(options.points);
    const double scale = std::max(1.0, std::cbrt(points / kMostUnscaled));
    const int count = std::max(6, static_cast<int>(0.57 * std::sqrt(points)));
    const Box3 box = extent(liver());
    const std::vector<Plane> planes =
        options.orthogonal ? orthogonal_planes(box, count / 3, count / 3, count / 3) : parallel_planes(box, count);
    PhantomCase result;
    result.name = "dense_liver";
    result.note = "a liver cut by many planes";
    result.body = scaled(liver(), scale);
    // Drawn at its natural size, because the time to draw a section grows with its area.
    result.contours = scaled(draw_sections(liver(), planes, options.points), scale);
    if (options.by_hand) {
        Random random(seed_of(result.name));
        result.contours = drawn_by_hand(std::move(result.contours), *result.body, {}, random);
    }
    result.grid = grid_around(bounding_box(result.contours), Vec3{scale, scale, scale}, 12);
    result.normals = surface_normals(*result.body, result.contours);
    return result;
}

}  // namespace kontur
