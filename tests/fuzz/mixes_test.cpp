// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

#include "fuzz/drawings.h"
#include "fuzz/targets.h"
#include "kontur/base/error.h"
#include "kontur/fit/fit.h"
#include "kontur/pipeline.h"
#include "support/random.h"

namespace kontur::fuzz {
namespace {

std::vector<std::uint8_t> random_bytes(std::size_t count, std::mt19937& random) {
    std::vector<std::uint8_t> bytes(count);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
}

/// Contours, stretches, ends, holes, weights, points and clicks, and options of the fit; most of them can be fitted.
TEST(RandomMixes, OfDrawingsAndOptionsEndInAFunctionOrASentence) {
    std::mt19937 random = test::random_of_this_test();
    constexpr int kMixes = 150;
    std::map<std::string, int> refused;
    int fitted = 0;
    for (int mix = 0; mix < kMixes; ++mix) {
        try {
            fitting(random_bytes(6000, random));
            ++fitted;
        } catch (const Error& error) {
            ++refused[error.what()];
        }
    }
    for (const auto& [why, count] : refused) std::printf("%3d %s\n", count, why.c_str());
    EXPECT_GT(fitted, kMixes / 3) << "a generator of nonsense tests nothing but the checks";
}

/// As many points as drawings of organs have, thinned to very few of them.
TEST(RandomMixes, OfManyPointsCanBeThinnedToFew) {
    std::mt19937 random = test::random_of_this_test();
    int fitted = 0;
    for (int mix = 0; mix < 20; ++mix) {
        const std::vector<std::uint8_t> bytes = random_bytes(6000, random);
        Choices choose(bytes);
        const ContourSet set = mixed_drawing(choose);
        FitOptions options;
        options.tilt_points = options.most_points = 8;
        options.rounds = 1;
        options.most_solves = 2;
        try {
            const PreparedContours prepared = prepare(read_drawing(set, FillRule::even_odd), {.least_segments = 200});
            EXPECT_EQ(fit(prepared, options).slopes.size(), prepared.points.size());
            ++fitted;
        } catch (const Error&) {
        }
    }
    EXPECT_GT(fitted, 5);
}

/// The ball around all that was drawn and clicked inside.
Ball3 ball_of(const ContourSet& set) {
    std::vector<Vec3> points = set.interior;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    for (const SurfacePoint& p : set.surface) points.push_back(p.position);
    return smallest_ball(points);
}

int number_from(const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    return text ? std::atoi(text) : otherwise;
}

/// Contradictory contours, stretches, clicks: whatever is drawn, the object ends. False: it could not be fitted.
bool expect_end_of_drawing(int mix) {
    std::mt19937 random(static_cast<unsigned>(mix));
    std::normal_distribution<double> normal;
    const std::vector<std::uint8_t> bytes = random_bytes(6000, random);
    Choices choose(bytes);
    const ContourSet set = mixed_drawing(choose);
    ImplicitFunction f;
    try {
        const Drawing drawing = read_drawing(set, FillRule::even_odd);
        const StageOptions stages = stage_options({.quality = 0.3}, drawing.diameter_mm());
        f = fit(prepare(drawing, stages.prepare), stages.fit).function;
    } catch (const Error&) {
        return false;
    }
    const Ball3 ball = ball_of(set);
    for (const double reach : {2.0, 2.5, 3.0, 4.0, 6.0, 12.0, 50.0}) {
        double most = -std::numeric_limits<double>::infinity();
        for (int direction = 0; direction < 100; ++direction) {
            const Vec3 d = normalized({normal(random), normal(random), normal(random)});
            most = std::max(most, f.value(ball.center + reach * ball.radius * d));
        }
        EXPECT_LT(most, 0) << "drawing " << mix << " at " << reach << " radii of " << ball.radius << " mm";
    }
    return true;
}

/// KONTUR_DRAWINGS says of how many, from KONTUR_FIRST_DRAWING on.
TEST(RandomMixes, AreNowhereInsideBeyondTwiceTheBallOfWhatWasDrawn) {
    const int mixes = number_from("KONTUR_DRAWINGS", 60), first = number_from("KONTUR_FIRST_DRAWING", 0);
    int fitted = 0;
    for (int mix = first; mix < first + mixes; ++mix) fitted += expect_end_of_drawing(mix);
    EXPECT_GT(fitted, mixes / 2);
}

/// Open contours beyond which nothing was drawn: of 4,000 drawings, the two that were inside at twice the ball before its
/// bounds were there.
TEST(RandomMixes, OfOpenContoursEndBeyondTheLastOfThem) {
    for (const int mix : {81, 2958}) EXPECT_TRUE(expect_end_of_drawing(mix));
}

}  // namespace
}  // namespace kontur::fuzz
