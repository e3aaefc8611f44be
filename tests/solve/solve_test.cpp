// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/solve.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kontur/fit/constraints.h"
#include "kontur/fit/prepare.h"
#include "support/contour_sets.h"
#include "support/expect_error.h"
#include "support/random.h"

namespace kontur {
namespace {

constexpr Solver kSolvers[] = {Solver::dense, Solver::cholesky, Solver::iterative};
constexpr Kernel kKernels[] = {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic};
constexpr Kernel kKernelsWithPolynomial[] = {Kernel::triharmonic, Kernel::biharmonic};

std::vector<Vec3> random_points(std::size_t count, std::mt19937& random) {
    std::uniform_real_distribution<double> coordinate(-30, 30);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return points;
}

ConstraintSet random_constraints(std::size_t count, std::mt19937& random) {
    ConstraintSet set;
    set.centers = random_points(count, random);
    for (const Vec3& p : set.centers) set.values.push_back(25 - norm(p) + std::sin(p.x));
    return set;
}

/// What the pipeline solves: circles of a ball in planes of three directions, which cross and contradict each other.
ConstraintSet crossing_contours(int points_per_circle) {
    ContourSet set;
    for (int axis = 0; axis < 3; ++axis)
        for (const double at : {-12.0, -3.0, 8.0}) {
            Vec3 normal{}, origin{};
            normal[axis] = 1;
            origin[axis] = at;
            set.contours.push_back(test::circle(make_plane(origin, normal), std::sqrt(400 - at * at), points_per_circle));
        }
    const PreparedContours prepared = prepare(set);
    return place_constraints(prepared.points, std::vector<double>(prepared.points.size(), 1.0), {},
                             {.normal_offset_mm = 0.3, .merge_distance_mm = 0.05})
        .constraints;
}

double largest_error(const ImplicitFunction& function, const ConstraintSet& set) {
    double largest = 0;
    for (std::size_t i = 0; i < set.size(); ++i)
        largest = std::max(largest, std::abs(function.value(set.centers[i]) - set.values[i]));
    return largest;
}

double largest_weight(const ImplicitFunction& function) {
    double largest = 0;
    for (const double w : function.weights()) largest = std::max(largest, std::abs(w));
    return largest;
}

TEST(Solve, EverySolverInterpolatesWithEveryKernel) {
    std::mt19937 random = test::random_of_this_test();
    for (const ConstraintSet& set : {random_constraints(4, random), random_constraints(5, random),
                                     random_constraints(300, random), crossing_contours(60)})
        for (const Kernel kernel : kKernels)
            for (const Solver solver : kSolvers) {
                const Solution solution =
                    solve(set, {.kernel = kernel, .solver = solver, .smoothing = 0, .tolerance_mm = 1e-3});
                const double limit = solver == Solver::iterative ? 1.1e-3 : 1e-6,
                             error = largest_error(solution.function, set);
                EXPECT_LT(error, limit) << name(solver) << " " << name(kernel) << " " << set.size();
                EXPECT_NEAR(solution.report.residual, error, 1e-6);
                EXPECT_EQ(solution.report.solver, solver);
                EXPECT_EQ(solution.report.centres, set.size());
            }
}

TEST(Solve, WeightsMeetTheSideConditions) {
    std::mt19937 random = test::random_of_this_test();
    for (const ConstraintSet& set : {random_constraints(300, random), crossing_contours(60)})
        for (const Solver solver : kSolvers) {
            const ImplicitFunction function = solve(set, {.kernel = Kernel::triharmonic, .solver = solver}).function;
            double sum = 0;
            Vec3 moment;
            for (std::size_t i = 0; i < set.size(); ++i) {
                sum += function.weights()[i];
                moment += function.weights()[i] * function.centers()[i];
            }
            EXPECT_LT(std::abs(sum), 1e-8 * largest_weight(function)) << name(solver);
            EXPECT_LT(norm(moment), 1e-8 * largest_weight(function)) << name(solver);
        }
}

TEST(Solve, SolversAgreeWithAndWithoutSmoothing) {
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> probes = random_points(200, random);
    for (const ConstraintSet& set : {random_constraints(300, random), crossing_contours(60)})
        for (const Kernel kernel : kKernels)
            for (const double smoothing : {0.0, 1e-3}) {
                const auto run = [&](Solver solver) {
                    return solve(set, {.kernel = kernel, .solver = solver, .smoothing = smoothing, .tolerance_mm = 1e-6})
                        .function;
                };
                const ImplicitFunction dense = run(Solver::dense), cholesky = run(Solver::cholesky),
                                       iterative = run(Solver::iterative);
                const double scale = largest_weight(dense);
                for (std::size_t i = 0; i < set.size(); ++i)
                    ASSERT_NEAR(cholesky.weights()[i], dense.weights()[i], 1e-5 * scale);
                for (const Vec3& p : probes) {
                    ASSERT_NEAR(cholesky.value(p), dense.value(p), 1e-6) << name(kernel) << " " << smoothing;
                    ASSERT_NEAR(iterative.value(p), dense.value(p), 1e-3) << name(kernel) << " " << smoothing;
                }
            }
}

TEST(Solve, SmoothingTradesTheResidualForSmallerWeights) {
    const ConstraintSet set = crossing_contours(40);
    for (const Kernel kernel : kKernels)
        for (const Solver solver : kSolvers) {
            const auto smoothed = [&](double smoothing) {
                return solve(set, {.kernel = kernel, .solver = solver, .smoothing = smoothing, .tolerance_mm = 1e-3})
                    .function;
            };
            const ImplicitFunction exact = smoothed(0);
            const ImplicitFunction smooth = smoothed(1e-3);
            for (std::size_t i = 0; i < set.size(); ++i)
                ASSERT_NEAR(smooth.value(set.centers[i]) + kernel_sign(kernel) * 1e-3 * smooth.weights()[i], set.values[i],
                            1.1e-3);
            EXPECT_LT(largest_weight(smooth), largest_weight(exact)) << name(solver) << " " << name(kernel);
        }
}

TEST(Solve, ReproducesLinearPolynomials) {
    std::mt19937 random = test::random_of_this_test();
    ConstraintSet set = random_constraints(200, random);
    const auto linear = [](const Vec3& p) { return 3 - 0.5 * p.x + 2 * p.y + p.z; };
    for (std::size_t i = 0; i < set.size(); ++i) set.values[i] = linear(set.centers[i]);
    for (const Kernel kernel : kKernelsWithPolynomial)
        for (const Solver solver : kSolvers) {
            const ImplicitFunction function = solve(set, {.kernel = kernel, .solver = solver}).function;
            for (const Vec3& p : random_points(50, random)) EXPECT_NEAR(function.value(2 * p), linear(2 * p), 1e-6);
            EXPECT_LT(distance(function.gradient({1, 2, 3}), {-0.5, 2, 1}), 1e-7) << name(solver);
        }
}

TEST(Solve, OffsetAndScaleOfThePatientFrameDoNotMatter) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet set = crossing_contours(40);
    const std::vector<Vec3> probes = random_points(100, random);
    for (const Kernel kernel : kKernels)
        for (const Solver solver : kSolvers) {
            SolveOptions options{.kernel = kernel, .solver = solver, .tolerance_mm = 1e-6};
            const ImplicitFunction here = solve(set, options).function;
            for (const double scale : {1e-3, 1.0, 1e3}) {
                const Vec3 offset = scale * Vec3{1000, -700, 300};
                ConstraintSet there = set;
                for (Vec3& c : there.centers) c = scale * c + offset;
                for (double& value : there.values) value *= scale;
                options.tolerance_mm = 1e-6 * scale;
                const ImplicitFunction function = solve(there, options).function;
                for (const Vec3& p : probes)
                    ASSERT_NEAR(function.value(scale * p + offset) / scale, here.value(p), 1e-3)
                        << name(kernel) << " " << name(solver) << " " << scale;
            }
        }
}

TEST(Solve, TheScreenedKernelIsNegativeFarAway) {
    const ConstraintSet set = crossing_contours(60);
    for (const Solver solver : kSolvers) {
        const ImplicitFunction function = solve(set, {.kernel = Kernel::screened, .solver = solver}).function;
        const UnitFrame& frame = function.frame();
        EXPECT_EQ(function.polynomial(), (std::array<double, 4>{kMeanRadii * frame.scale, 0, 0, 0}));
        for (const double reach : {1.25, 2.0, 5.0, 100.0})
            EXPECT_LT(function.value(frame.center + Vec3{reach * frame.scale, 0, 0}), 0) << reach;
    }
}

TEST(Solve, TheScreenedKernelGoesBackToTheMeanThatIsAskedFor) {
    const ConstraintSet set = crossing_contours(60);
    ConstraintSet above = set;
    const double radius = solve(set, {.kernel = Kernel::screened}).function.frame().scale;
    for (double& value : above.values) value += radius;
    const ImplicitFunction usual = solve(set, {.kernel = Kernel::screened}).function;
    const ImplicitFunction about_0 = solve(above, {.kernel = Kernel::screened, .mean_radii = 0}).function;
    EXPECT_EQ(about_0.polynomial(), (std::array<double, 4>{}));
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.5, 0.25, -0.5}, set.centers.front()})
        EXPECT_NEAR(about_0.value(p), usual.value(p) + radius, 1e-6 * radius);
}

/// So many that the residual is checked at samples only.
TEST(Solve, TheScreenedKernelServesVeryManyConstraints) {
    ConstraintSet set;
    constexpr int kCount = 64000;
    for (int i = 0; i < kCount; ++i) {  // a spiral over a ball of 50 mm
        const double z = 1 - (2.0 * i + 1) / kCount, azimuth = 2.399963 * i, r = std::sqrt(1 - z * z);
        set.centers.push_back(50.0 * Vec3{r * std::cos(azimuth), r * std::sin(azimuth), z});
        set.values.push_back(std::sin(0.1 * set.centers.back().x));
    }
    const Solution solution = solve(set, {.kernel = Kernel::screened, .smoothing = 1e-5, .tolerance_mm = 1e-2});
    EXPECT_LT(solution.report.residual_points, set.size());
    EXPECT_LT(solution.report.residual, 1e-2);
}

TEST(Solve, TheBallOfWhatWasDrawnSetsTheUnit) {
    const ConstraintSet set = crossing_contours(40);
    const Ball3 ball{{1, 2, 3}, 50};
    const ImplicitFunction function =
        solve(set, {.kernel = Kernel::screened, .ball = ball, .solver = Solver::cholesky, .smoothing = 0}).function;
    EXPECT_EQ(function.frame().center, ball.center);
    EXPECT_EQ(function.frame().scale, ball.radius);
    EXPECT_LT(largest_error(function, set), 1e-6);
}

TEST(Solve, AConstraintIsSmoothedAsInADrawingOfItsExtent) {
    std::mt19937 random = test::random_of_this_test();
    ConstraintSet part = random_constraints(40, random);
    part.noise_mm.assign(part.size(), 0.3);
    const Ball3 alone{{}, 20}, whole{{}, 80};
    SolveOptions options{.kernel = Kernel::triharmonic, .solver = Solver::cholesky, .smoothing = 1e-4};
    options.ball = alone;
    // The kernel without a mean knows no unit, so the same smoothing makes the same function.
    const Solution smoothed = solve(part, options);
    part.extents.assign(part.size(), alone.radius / whole.radius);
    options.ball = whole;
    const Solution in_wide = solve(part, options);
    part.extents.clear();
    const Solution too_smooth = solve(part, options);
    for (const Vec3& p : part.centers) EXPECT_NEAR(in_wide.function.value(p), smoothed.function.value(p), 1e-6);
    EXPECT_GT(std::abs(too_smooth.function.value(part.centers[0]) - smoothed.function.value(part.centers[0])), 1e-4);
}

TEST(Solve, SameBytesForAnyNumberOfThreads) {
    const ConstraintSet set = crossing_contours(70);  // several tiles and supernodes
    ASSERT_GT(set.size(), 1000u);
    for (const Solver solver : kSolvers) {
        const ImplicitFunction one = solve(set, {.solver = solver}, {.threads = 1}).function;
        for (const int threads : {2, 3, 8}) {
            const ImplicitFunction many = solve(set, {.solver = solver}, {.threads = threads}).function;
            EXPECT_TRUE(std::ranges::equal(many.weights(), one.weights())) << name(solver) << " " << threads;
            EXPECT_EQ(many.polynomial(), one.polynomial()) << name(solver) << " " << threads;
        }
    }
}

TEST(Solve, RefusesCentresInOnePlaneWhereAPolynomialNeedsMore) {
    std::mt19937 random = test::random_of_this_test();
    for (const Plane& plane : {Plane{}, make_plane({100, 200, 300}, {0.3, -0.5, 0.8})}) {
        ConstraintSet set = random_constraints(100, random);
        for (Vec3& c : set.centers) c = plane.from_uv(c.x, c.y);
        for (const Kernel kernel : kKernelsWithPolynomial)
            for (const Solver solver : kSolvers)
                EXPECT_KONTUR_ERROR(solve(set, {.kernel = kernel, .solver = solver}), ErrorKind::singular_system,
                                    "one plane");
    }
}

TEST(Solve, TheScreenedKernelNeedsOneConstraintAndNoThirdDimension) {
    std::mt19937 random = test::random_of_this_test();
    ConstraintSet flat = random_constraints(100, random);
    for (Vec3& c : flat.centers) c.z = 0;
    for (const ConstraintSet& set : {flat, random_constraints(1, random), random_constraints(2, random)})
        for (const Solver solver : kSolvers)
            EXPECT_LT(largest_error(solve(set, {.solver = solver, .smoothing = 0, .tolerance_mm = 1e-3}).function, set),
                      1.1e-3)
                << name(solver) << " " << set.size();
}

TEST(Solve, RefusesCentresAtTheSamePoint) {
    std::mt19937 random = test::random_of_this_test();
    for (const double more : {0.0, 1.0}) {
        ConstraintSet set = random_constraints(100, random);
        set.centers[70] = set.centers[3];
        set.values[70] = set.values[3] + more;
        for (const Solver solver : kSolvers)
            EXPECT_KONTUR_ERROR(solve(set, {.solver = solver}), ErrorKind::singular_system, "constraints 4 and 71");
    }
}

TEST(Solve, RefusesADenseMatrixBeyondTheMemoryLimit) {
    ConstraintSet set;
    for (int i = 0; i < 1000000; ++i)
        set.centers.push_back({static_cast<double>(i), static_cast<double>(i % 100), static_cast<double>(i % 1000)});
    set.values.assign(set.centers.size(), 0);
    EXPECT_KONTUR_ERROR(solve(set, {.solver = Solver::dense}), ErrorKind::too_large, "needs 7629394 MB for 1000000 centres");
    EXPECT_KONTUR_ERROR(solve(set, {.solver = Solver::cholesky}), ErrorKind::too_large, "the limit is 16384 MB");
}

TEST(Solve, RefusesUnusableInput) {
    std::mt19937 random = test::random_of_this_test();
    const ConstraintSet good = random_constraints(10, random);
    EXPECT_KONTUR_ERROR(solve({}), ErrorKind::invalid_input, "0 constraints");
    EXPECT_KONTUR_ERROR(solve(random_constraints(3, random), {.kernel = Kernel::triharmonic}), ErrorKind::invalid_input,
                        "3 constraints");
    EXPECT_KONTUR_ERROR(solve(good, {.smoothing = -1}), ErrorKind::invalid_input, "smoothing");
    EXPECT_KONTUR_ERROR(solve(good, {.smoothing = std::nan("")}), ErrorKind::invalid_input, "smoothing");
    EXPECT_KONTUR_ERROR(solve(good, {.tolerance_mm = 0}), ErrorKind::invalid_input, "tolerance");
    EXPECT_KONTUR_ERROR(solve(good, {.tolerance_mm = std::nan("")}), ErrorKind::invalid_input, "tolerance");
    EXPECT_KONTUR_ERROR(solve(good, {.tolerance_mm = -1e-7}), ErrorKind::invalid_input, "is -1e-07 mm");
    EXPECT_KONTUR_ERROR(solve(good, {.mean_radii = std::numeric_limits<double>::infinity()}), ErrorKind::invalid_input,
                        "mean is inf radii");
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_KONTUR_ERROR(solve(good, {.smoothing = infinity}), ErrorKind::invalid_input, "the smoothing is inf");
    EXPECT_KONTUR_ERROR(solve(good, {.tolerance_mm = infinity}), ErrorKind::invalid_input, "tolerance is inf mm");
    EXPECT_KONTUR_ERROR(solve(good, {.ball = Ball3{{}, -5}}), ErrorKind::invalid_input, "a radius of -5 mm");
    EXPECT_KONTUR_ERROR(solve(good, {.ball = Ball3{{std::nan(""), 0, 0}, 5}}), ErrorKind::invalid_input, "the centre");
    ConstraintSet bad = good;
    bad.noise_mm = {1, 2};
    EXPECT_KONTUR_ERROR(solve(bad), ErrorKind::invalid_input, "2 noises");
    bad.noise_mm.assign(bad.size(), 0);
    bad.noise_mm[4] = -1;
    EXPECT_KONTUR_ERROR(solve(bad), ErrorKind::invalid_input, "the noise of constraint 5 is -1 mm");
    bad.noise_mm.clear();
    bad.extents.assign(bad.size(), 1);
    bad.extents[1] = 1.5;
    EXPECT_KONTUR_ERROR(solve(bad), ErrorKind::invalid_input, "the extent of constraint 2 is 1.5; it must be in (0, 1]");
    bad = good;
    bad.centers[6].y = std::nan("");
    EXPECT_KONTUR_ERROR(solve(bad), ErrorKind::invalid_input, "constraint 7 is not finite");
    bad = good;
    bad.values[2] = infinity;
    EXPECT_KONTUR_ERROR(solve(bad), ErrorKind::invalid_input, "constraint 3 is not finite");
}

TEST(Solve, RefusesASmoothingThatOverflows) {
    std::mt19937 random = test::random_of_this_test();
    ConstraintSet set = random_constraints(10, random);
    set.trust.assign(set.size(), 1.0);
    set.trust[3] = 0.1;
    for (const Solver solver : kSolvers)
        EXPECT_KONTUR_ERROR(solve(set, {.solver = solver, .smoothing = 1e308}), ErrorKind::invalid_input,
                            "divided by 0.1, the trust in constraint 4, it is not finite");
}

TEST(Solve, NeverGivesAFunctionThatIsNotFinite) {
    std::mt19937 random = test::random_of_this_test();
    ConstraintSet set = random_constraints(10, random);
    for (std::size_t i = 0; i < set.size(); ++i) set.values[i] = i % 2 ? 1e308 : -1e308;
    for (const Solver solver : kSolvers)
        EXPECT_KONTUR_ERROR(solve(set, {.solver = solver}), ErrorKind::singular_system,
                            solver == Solver::iterative ? "residual" : "finite");
}

TEST(Solve, NamesAResidualHoweverSmall) {
    const ConstraintSet set = crossing_contours(20);
    EXPECT_KONTUR_ERROR(solve(set, {.solver = Solver::iterative, .tolerance_mm = 1e-300}), ErrorKind::singular_system,
                        "; 1e-300 mm were asked for");
}

TEST(Solve, StopsWhenAskedTo) {
    const ConstraintSet set = crossing_contours(60);
    for (const Solver solver : kSolvers) {
        StopSource source;
        source.request_stop();
        EXPECT_KONTUR_ERROR(solve(set, {.solver = solver}, {.stop = source.token()}), ErrorKind::cancelled, "cancelled");
    }
    for (const Solver solver : {Solver::cholesky, Solver::iterative}) {  // half-way; dsysv cannot be interrupted
        StopSource source;
        int reports = 0;
        const auto stop_at_the_third = [&](std::string_view, double) {
            if (++reports == 3) source.request_stop();
        };
        EXPECT_KONTUR_ERROR(solve(set, {.solver = solver}, {.callback = stop_at_the_third, .stop = source.token()}),
                            ErrorKind::cancelled, "cancelled");
        EXPECT_EQ(reports, 3) << name(solver);
    }
}

TEST(Solve, HierarchicalProductsReachTheToleranceAndAgreeWithCholesky) {
    std::mt19937 random = test::random_of_this_test();
    const std::vector<Vec3> probes = random_points(300, random);
    for (const ConstraintSet& set : {crossing_contours(90), random_constraints(1200, random)})
        for (const Kernel kernel : kKernels)
            for (const double smoothing : {0.0, 1e-5}) {
                const Solution exact = solve(set, {.kernel = kernel, .solver = Solver::cholesky, .smoothing = smoothing});
                for (const double tolerance : {1e-2, 1e-5}) {
                    const Solution found = solve(set, {.kernel = kernel,
                                                       .smoothing = smoothing,
                                                       .tolerance_mm = tolerance,
                                                       .products = Products::hierarchical});
                    const auto what = testing::Message() << name(kernel) << " " << smoothing << " " << tolerance;
                    EXPECT_LE(found.report.residual, tolerance) << what;
                    EXPECT_EQ(found.report.residual_points, set.size()) << what;
                    if (smoothing == 0) {
                        EXPECT_NEAR(largest_error(found.function, set), found.report.residual, 1e-6) << what;
                    }
                    for (const Vec3& p : probes)
                        ASSERT_NEAR(found.function.value(p), exact.function.value(p), 100 * tolerance) << what;
                }
            }
}

TEST(Solve, HierarchicalProductsGiveTheSameBytesForAnyNumberOfThreads) {
    const ConstraintSet set = crossing_contours(80);
    const auto weights = [&](int threads) {
        const Solution solution = solve(set, {.products = Products::hierarchical}, {.threads = threads});
        return std::vector<double>(solution.function.weights().begin(), solution.function.weights().end());
    };
    const std::vector<double> one = weights(1);
    for (const int threads : {2, 5}) EXPECT_EQ(weights(threads), one) << threads;
}

}  // namespace
}  // namespace kontur
