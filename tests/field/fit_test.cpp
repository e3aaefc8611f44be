// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/fit.h"

#include <gtest/gtest.h>

#include "kontur/phantom/cases.h"

namespace kontur {
namespace {

/// Mean error in degrees of the surface's tilt against the contours' planes, as the fit's slopes say it.
double mean_tilt_error(const PhantomCase& c, const PreparedContours& prepared, const Fit& fitted) {
    double sum = 0;
    std::size_t point = 0;
    for (std::size_t k = 0; k < c.normals.size(); ++k)
        for (const Vec3& normal : c.normals[k]) {
            const double truth = std::acos(std::min(1.0, dot(normal, prepared.points[point].inplane_normal)));
            sum += std::abs(std::acos(std::min(1.0, fitted.slopes[point])) - truth);
            ++point;
        }
    EXPECT_EQ(point, fitted.slopes.size());
    return sum / static_cast<double>(point) * 180 / M_PI;
}

FitOptions options_for(const PhantomCase& c) {
    FitOptions options;
    const double diagonal = bounding_box(c.contours).diagonal();
    options.place.normal_offset_mm = 3e-3 * diagonal;
    options.place.merge_distance_mm = 4e-4 * diagonal;
    options.solve.smoothing = 1e-5;
    return options;
}

TEST(Fit, FindsTheTiltOfTheSurfaceFromAllContoursTogether) {
    for (const char* name : {"metastasis_parallel7", "kidney_radial6"}) {
        const PhantomCase c = phantom_case(name);
        const PreparedContours prepared = prepare(c.contours, {.least_segments = 0});
        FitOptions options = options_for(c);
        const Fit surface = fit(prepared, options);
        options.normals = Normals::in_plane;
        const Fit in_plane = fit(prepared, options);
        EXPECT_LT(mean_tilt_error(c, prepared, surface), 1.5) << name;
        EXPECT_GT(mean_tilt_error(c, prepared, in_plane), 8) << name << " leaves something to find";
        EXPECT_LT(surface.tilt_change_degrees, 1) << name;
        EXPECT_EQ(surface.solves, 4);
        EXPECT_EQ(in_plane.solves, 1);
        EXPECT_LE(surface.iterations, 10 * surface.solves) << name;
        for (const double slope : surface.slopes) {
            EXPECT_GE(slope, options.least_slope) << name;
            EXPECT_LE(slope, 1) << name;
        }
    }
}

TEST(Fit, FewIterationsOnThePapersLargestCase) {
    const PhantomCase c = phantom_case("liver_orthogonal14");
    FitOptions options = options_for(c);
    options.rounds = 1;
    const Fit fitted = fit(prepare(c.contours), options);
    EXPECT_GT(fitted.constraints, 13000u);
    EXPECT_LE(fitted.iterations, 15 * fitted.solves);
}

}  // namespace
}  // namespace kontur
