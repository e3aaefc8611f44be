// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kontur/field/kernel.h"

namespace kontur {

struct PreconditionerOptions {
    int neighbours = 128;            ///< earlier points that a point's row is conditioned on
    int supernode = 32;              ///< most points that share their neighbours
    int dense_top = 800;             ///< coarsest points, factorised exactly
    double polynomial_weight = 100;  ///< multiple of 1 + x.y that makes the local matrices definite
};

/// Points from coarse to fine: `order` lists the points so that every prefix is spread evenly; level l fills
/// [level_begin[l], level_begin[l + 1]) and its points are about `spacing[l]` apart.
struct MultiscaleOrder {
    std::vector<std::int32_t> order;
    std::vector<std::int32_t> level_begin;
    std::vector<double> spacing;
};
MultiscaleOrder multiscale_order(const PointArrays& points);

/// A sparse approximate inverse Cholesky factor G of the kernel matrix, M^-1 = G^T G (Kaporin 1994; Vecchia 1988; supernodes
/// after Schaefer, Katzfuss & Owhadi 2021): every point's row is the exact one given its nearest coarser points. The
/// coarsest points are factorised densely, which carries the global part. O(n) memory; set-up O(n k^2) for k neighbours.
class Preconditioner {
public:
    /// `sign` * phi + `diagonal` on the points is the matrix; see kernel_sign.
    Preconditioner(Kernel kernel, const PointArrays& points, double diagonal, const PreconditionerOptions& options,
                   int threads);

    /// z = M^-1 r. The same bytes for any number of threads.
    void apply(std::span<const double> r, std::span<double> z, int threads) const;

    double megabytes() const;

private:
    struct Supernode {
        std::int32_t begin, members;  ///< consecutive points in order
        std::int32_t neighbours;      ///< how many earlier points
        std::size_t columns;          ///< offset into columns_: neighbours, then members (positions in order)
        std::size_t rows;             ///< offset into rows_: members x (neighbours + members), row major
    };

    void cut_into_supernodes(const MultiscaleOrder& order, const PreconditionerOptions& options);
    void find_neighbours(const MultiscaleOrder& order, const PreconditionerOptions& options, int threads);
    void factorise_top(Kernel kernel, double diagonal, const PreconditionerOptions& options);
    void factorise_supernodes(Kernel kernel, double diagonal, const PreconditionerOptions& options, int threads);

    std::vector<std::int32_t> order_;
    PointArrays points_;  ///< in order
    std::int32_t top_ = 0;
    std::vector<double> top_factor_;  ///< column major, lower
    double top_scale_ = 1;
    std::vector<Supernode> supernodes_;
    std::vector<std::int32_t> columns_;
    std::vector<float> rows_;
};

}  // namespace kontur
