// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace kontur {

/// The value below which a fraction (0 to 1) of the values lies, linear between neighbours in order (Hyndman and Fan 1996,
/// type 7). At least one value; none NaN. O(n).
double quantile(std::vector<double> values, double fraction);
double median(std::vector<double> values);
/// The standard deviation over the median of absolute values of a normal distribution.
inline constexpr double kDeviationOfMedian = 1.4826;

/// The same of values in ascending order. O(1).
double quantile_of_sorted(std::span<const double> sorted, double fraction);

/// The value below which a fraction of the weights' sum lies: the first in order at which it is reached. O(n log n).
double weighted_quantile(std::span<const double> values, std::span<const double> weights, double fraction);

}  // namespace kontur
