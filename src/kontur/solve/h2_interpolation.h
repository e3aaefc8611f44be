// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/solve/h2_cluster_tree.h"

namespace kontur {

/// A matrix A (rows x columns) is nearly A(:, skeleton) [I T]: a few of its own columns, the skeleton, span all others.
struct Interpolation {
    std::int32_t rank = 0;
    std::vector<std::int32_t> columns;  ///< a permutation of all columns, the skeleton first
    std::vector<double> transfer;       ///< T, rank x (columns - rank), column major
};

/// skeleton = [I T] candidates: moves the weights of all columns to the skeleton's.
void condense(const Interpolation& interpolation, const double* candidates, double* skeleton);
/// candidates += [I T]^T skeleton: interpolates a field from the skeleton.
void expand(const Interpolation& interpolation, const double* skeleton, double* candidates);

/// The interpolative decomposition by Gram-Schmidt with column pivoting (Cheng, Gimbutas, Martinsson & Rokhlin 2005): the
/// skeleton grows until no other column is farther than `tolerance` (root mean square over the rows) from its span.
/// `a` is column major, its columns `lead` apart, a multiple of kRowsPerStep with zeros below `rows`; it is overwritten.
Interpolation interpolate_columns(double* a, std::int32_t rows, std::int32_t lead, std::int32_t columns, double tolerance);

constexpr std::int32_t kRowsPerStep = 16;

/// Points that stand for everything far from a cluster: on shells around its box, from the nearest admissible distance
/// out to where the other points end. r and r^3 are fundamental solutions of the bi- and triharmonic equation, so what
/// interpolates a cluster's field on a few such shells interpolates it between and beyond them.
class ProxyShells {
public:
    /// For points that all lie within `reach` of each other.
    ProxyShells(std::int32_t most, double reach);

    /// The first `count` proxies around the box at the distance `nearest` and more.
    PointArrays around(const Cluster& cluster, double nearest, std::int32_t count) const;

private:
    struct Proxy {
        Vec3 on_cube;    ///< a point on the surface of [-1, 1]^3
        double outward;  ///< position among the shells: 0 the nearest, 1 at reach
        double jitter;
    };
    std::vector<Proxy> proxies_;
    double reach_;
};

}  // namespace kontur
