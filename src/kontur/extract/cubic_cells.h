// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kontur/extract/coarse_band.h"

namespace kontur {

/// Interpolates in the cells of a coarse lattice by cubics through the 4 nodes around along each axis with a stride above 1.
/// Cells agree to the last bit where they meet.
class CubicCells {
public:
    explicit CubicCells(const CoarseLattice& lattice);

    /// The values at all points of the grid in a cell, its faces included: (stride.i + 1) x ... values, i fastest.
    void interpolate(const Index3& cell, std::vector<double>& values) const;

    /// At one place, given as a fraction in [0, 1]^3 of the cell.
    double interpolate_at(const Index3& cell, const Vec3& fraction) const;

private:
    using Weights = std::array<double, 4>;

    Weights weights_at(double t, int axis) const;
    std::array<double, 64> stencil(const Index3& cell) const;

    const CoarseLattice& lattice_;
    std::array<std::vector<Weights>, 3> weights_;  ///< of every point along an axis
};

}  // namespace kontur
