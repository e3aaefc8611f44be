// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "kontur/function/implicit_function.h"
#include "kontur/solve/kernel_matrix.h"
#include "kontur/solve/linear_system.h"
#include "kontur/solve/preconditioner.h"

namespace kontur {

/// What the iterative solver makes of its centres before it iterates. The next system shares it where it has other values
/// and a few other centres: those that it lacks stay with a noise without end, and those that it adds stand behind the
/// others.
struct SolverSetup {
    PointArrays centers;
    std::vector<double> smoothing;
    std::vector<double> weights;  ///< that solved the system
    std::size_t first_centers;    ///< of the system that it was made for; those behind them were added since
    std::shared_ptr<const Preconditioner> preconditioner;
    std::shared_ptr<const KernelMatrix> matrix;
    double matrix_tolerance;
};

/// A system in which others share a setup.
struct SharedSystem {
    LinearSystem system;
    std::vector<std::size_t> places;  ///< in it, of the centres of the system that it stands for
};

/// It starts from the weights of the setup's system, which centres left out hand over to their neighbours. Nothing where too
/// many centres differ, or where those of both are smoothed otherwise.
std::optional<SharedSystem> share(const LinearSystem& system, std::shared_ptr<const SolverSetup> setup);

}  // namespace kontur
