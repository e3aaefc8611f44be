// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace kontur::bench {

/// Makes OpenBLAS use the kernels that fit this CPU, unless OPENBLAS_CORETYPE is set already: releases older than a CPU take
/// their slowest kernels for it, which would make the dense reference look unfairly slow. OpenBLAS reads the variable when
/// it is loaded, so the program starts itself again and, once it has, returns from here.
void restart_with_fitting_blas(char** arguments);

/// Processor, cores, load, compiler and BLAS kernels.
nlohmann::ordered_json describe_machine();

/// Resident memory that a piece of work adds at its peak, on Linux.
class PeakMemory {
public:
    /// Counts from here.
    PeakMemory();
    /// MB on top of what the process held at the start; NaN where the system does not tell.
    double added_mb() const;

private:
    double before_mb_;
};

}  // namespace kontur::bench
