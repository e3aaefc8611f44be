// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/extract/coarse_band.h"

namespace kontur {

/// The values at all points of the grid in a coarse cell, its faces included: (stride.i + 1) x ... values, i fastest, by
/// cubics through the 4 nodes around along each axis with a stride above 1.
std::vector<double> interpolate_cell(const CoarseLattice& lattice, const Index3& cell);

/// The same interpolant at one place, given as a fraction in [0, 1]^3 of the cell.
double interpolate_in_cell(const CoarseLattice& lattice, const Index3& cell, const Vec3& fraction);

}  // namespace kontur
