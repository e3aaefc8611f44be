// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur {

/// The radial basis function phi(r) of variational interpolation (paper Eq. 3 and 4).
enum class Kernel {
    screened,     ///< r^3 that goes back to a mean far from all centres: phi of screened_kernel.h
    triharmonic,  ///< r^3: C2, minimises the third-derivative energy; what the paper uses
    biharmonic,   ///< r: C0 at the centres, minimises the second-derivative energy of Eq. 1
};
std::string_view name(Kernel kernel) noexcept;

}  // namespace kontur
