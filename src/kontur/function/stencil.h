// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kontur/base/geometry.h"

namespace kontur {

/// Interpolation on a regular lattice of spacing 1 by polynomials of degree 7 along each axis, in the middle of 8 nodes.
constexpr std::size_t kStencil = 8;
/// The nodes -3 .. 4 around a cell along each axis, i fastest.
using StencilValues = std::array<double, kStencil * kStencil * kStencil>;
constexpr std::int64_t kStencilBefore = 3;

/// `at` in [0, 1]^3 within the cell.
double interpolate(const StencilValues& nodes, const Vec3& at);
/// Gradient of the same polynomial.
Vec3 interpolate_gradient(const StencilValues& nodes, const Vec3& at);

}  // namespace kontur
