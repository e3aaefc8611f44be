// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/function/kernel_sums.h"
#include "kontur/solve/constraint_set.h"
#include "kontur/solve/solver.h"

namespace kontur {

/// The mean of the screened kernel's functions in radii of the ball, outside.
inline constexpr double kMeanRadii = -1;

/// Where no length is given, of the diameter of what was drawn: 0.004 mm on a liver.
inline constexpr double kToleranceFraction = 1.5e-5;
/// Where none is given. docs/decisions/0001-surface-normals.md has the measurements.
inline constexpr double kSmoothing = 1e-5;

struct SolveOptions {
    Kernel kernel = Kernel::screened;
    std::optional<Ball3> ball{};     ///< mm, of what was drawn, sets the unit; unset: the smallest one of all constraints
    double mean_radii = kMeanRadii;  ///< screened kernel: the functions' mean, in radii of the ball
    Solver solver = Solver::automatic;
    /// >= 0, on unit coordinates, divided by each constraint's trust; 0: exact; unset: kSmoothing, or 0 where `fit` takes
    /// in-plane normals.
    std::optional<double> smoothing{};
    /// Iterative only: largest |f(c_i) - h_i| over all constraints at which it stops; unset: kToleranceFraction of the
    /// ball's diameter.
    std::optional<double> tolerance_mm{};
    int max_iterations = 500;                 ///< iterative only
    Products products = Products::automatic;  ///< iterative only
    double max_memory_mb = 16384;             ///< a dense matrix larger than this is refused
};

/// The same options with the smoothing and the tolerance for what was drawn where they are not given.
SolveOptions resolved(SolveOptions options, double diameter_mm);

/// Throws Error(invalid_input) for a tolerance or memory limit that is not above 0, a smoothing below 0, a tolerance or
/// smoothing that is not finite, fewer than one iteration, and threads below 0.
void check_solve_options(const SolveOptions& options);

struct SolveReport {
    Solver solver = Solver::automatic;  ///< the one that ran
    std::size_t centres = 0;            ///< number of weights
    int iterations = 0;                 ///< 0 for direct solvers
    double residual = 0;                ///< largest |f(c_i) + smoothing w_i - h_i| over the constraints, in mm
    /// Constraints at which the residual was summed over all pairs. If they are not all, as beyond 7,000 centres, it is that
    /// of the H2 matrix at all constraints plus the matrix's largest error at these.
    std::size_t residual_points = 0;
    double matrix_mb = 0;    ///< size of the factorised matrix or of the preconditioner
    double evaluations = 0;  ///< iterative only: values of phi computed per product with the matrix
    std::vector<std::pair<std::string, double>> seconds = {};  ///< iterative only: wall time by stage
};

struct Solution {
    ImplicitFunction function;
    SolveReport report;
};

class PreconditionerPattern;
struct SolverSetup;

/// What a solve leaves to the next one of a similar problem.
struct PreviousSolve {
    std::vector<Vec3> centers;    ///< mm
    std::vector<double> weights;  ///< of phi of distances in mm
    std::shared_ptr<const PreconditionerPattern> pattern = {};
    std::shared_ptr<const SolverSetup> setup = {};
};

/// The variational interpolant through the constraints: with the screened kernel the function that departs least from its
/// mean, with the others Eq. 2-6 with the side conditions sum w = 0 and sum w c = 0.
/// Throws Error(singular_system) when the centres coincide or, but for the screened kernel, all lie in one plane,
/// Error(too_large) when the dense matrix would exceed the memory limit, Error(invalid_input) for no constraint (fewer than
/// 4 with other kernels than the screened), values that are not finite or not one for each centre, or what
/// `check_solve_options` refuses.
/// Results are the same bytes for any number of threads. The iterative solver starts from the weights that centres had in
/// the `previous` solve, which is replaced by this one; so it takes fewer iterations to the same tolerance.
Solution solve(const ConstraintSet& constraints, const SolveOptions& options = {}, const Work& work = {},
               PreviousSolve* previous = nullptr);

}  // namespace kontur
