// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kontur/function/screened_kernel.h"

namespace kontur {

/// The smoothing, on unit coordinates, that a noise of so many radii is worth, if functions are taken to have gradients of
/// length 1 in the mean: the screened kernel's have one of length sqrt(9 l).
inline double smoothing_of_noise(double radii) { return 9 * kScreeningLength * std::pow(radii, 2); }

}  // namespace kontur
