// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// phi(r) split at a radius R into a smooth part, which equals phi beyond R and is a polynomial in r^2 within, and a near
/// part, which is the rest and vanishes beyond R. With q = (r / R)^2 the polynomial is the Taylor series of q^(3/2) (for
/// phi = r: q^(1/2)) about q = 1 up to (q - 1)^5, so the smooth part has five continuous derivatives (cf. the multilevel
/// summation method, Hardy et al. 2015). Summed over all centres, the smooth part is f averaged over balls of radius R: no
/// larger than f, however large the weights are, because the Laplacians that annihilate phi turn the rest into an average.
/// A cut without transition would leave sums that are many orders of magnitude larger than f.
///
/// Of the screened kernel only the odd powers of r are split, r^3 + r^5 / (10 l^2) + r^7 / (280 l^4) + ..., of which the
/// first three matter for radii up to l: the even ones are polynomials in r^2 and thus smooth as they are.
constexpr int kSplitDegree = 5;
constexpr std::size_t kSplitPowers = 3;

/// The odd powers that a kernel has, divided by the lowest: phi = R^m q^(m / 2) (1 + c1 q + c2 q^2) at the radius R.
std::array<double, kSplitPowers> odd_powers(Kernel kernel, double radius);

/// Coefficients of the smooth part's polynomial in q, lowest first, divided by R^m.
std::array<double, kSplitDegree + 1> split_polynomial(Kernel kernel, double radius);

constexpr std::size_t kNearLanes = 8;

/// Centres and weights, filled up to a multiple of the lanes with centres of weight 0.
struct NearSources {
    std::vector<double> x, y, z, w;
};

/// Sums of the near part over the sources at one target: lanes of partial sums, added up at the end.
class NearKernel {
public:
    NearKernel(Kernel kernel, double radius);

    double value(const NearSources& sources, const Vec3& target) const;
    Vec3 gradient(const NearSources& sources, const Vec3& target) const;

private:
    Kernel kernel_;
    double radius_;
    std::array<double, kSplitPowers> powers_, power_slopes_{};
    std::array<double, kSplitDegree + 1> polynomial_, slope_{};
};

}  // namespace kontur
