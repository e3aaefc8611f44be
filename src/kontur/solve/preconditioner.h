// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"
#include "kontur/solve/multiscale_order.h"

namespace kontur {

struct PreconditionerOptions {
    int neighbours = 0;              ///< earlier points that a point's row is conditioned on; 0: what fits their number
    int supernode = 32;              ///< most points that share their neighbours
    int dense_top = 0;               ///< coarsest points, factorised exactly; 0: what fits the number of all
    double polynomial_weight = 100;  ///< multiple of 1 + x.y that makes the local matrices definite
};

/// Which entries of the sparse factor are not zero. It depends on the points only, so that systems with other diagonals,
/// kernels and values share it.
class PreconditionerPattern {
public:
    explicit PreconditionerPattern(const PointArrays& points, const PreconditionerOptions& options = {},
                                   const Work& work = {});
    /// Of more points, the first of which are those of `earlier`: the others come last in order, each by itself.
    PreconditionerPattern(const PreconditionerPattern& earlier, const PointArrays& points);

    /// Consecutive points in order that share their neighbours.
    struct Supernode {
        std::int32_t begin, members;
        std::int32_t neighbours;  ///< how many earlier points
        std::size_t columns;      ///< offset into `columns`: neighbours, then members

        std::int32_t size() const { return neighbours + members; }
    };

    const PreconditionerOptions& options() const { return options_; }
    const PointArrays& points() const { return points_; }              ///< in order
    const std::vector<std::int32_t>& order() const { return order_; }  ///< the given points, from coarse to fine
    std::int32_t top() const { return top_; }                          ///< how many points are factorised densely
    const std::vector<Supernode>& supernodes() const { return supernodes_; }
    std::span<const std::int32_t> columns(const Supernode& node) const {
        return std::span(columns_).subspan(node.columns, static_cast<std::size_t>(node.size()));
    }
    std::size_t column_count() const { return columns_.size(); }
    /// Where in the columns of all supernodes a point occurs, ascending.
    std::span<const std::uint32_t> occurrences(std::int32_t point) const {
        return std::span(occurrences_)
            .subspan(first_occurrence_[point], first_occurrence_[point + 1] - first_occurrence_[point]);
    }

private:
    void cut_into_supernodes(const MultiscaleOrder& order);
    void find_neighbours(const Work& work);
    void index_occurrences();

    PreconditionerOptions options_;
    std::vector<std::int32_t> order_;
    PointArrays points_;
    std::int32_t top_ = 0;
    std::vector<Supernode> supernodes_;
    std::vector<std::int32_t> columns_;
    std::vector<std::uint32_t> occurrences_;
    std::vector<std::size_t> first_occurrence_;
};

/// That of an earlier matrix, and that of one with further points.
struct Diagonals {
    std::span<const double> earlier, now;
};

/// A sparse approximate inverse Cholesky factor G of the kernel matrix, M^-1 = G^T G (Kaporin 1994; Vecchia 1988; supernodes
/// after Schaefer, Katzfuss & Owhadi 2021): every point's row is the exact one given its nearest coarser points. The
/// coarsest points are factorised densely, which carries the global part. O(n) memory; set-up O(n k^2) for k neighbours.
class Preconditioner {
public:
    /// `sign` * phi on the pattern's points, and `diagonal` (one per given point) added, is the matrix; see kernel_sign.
    Preconditioner(Kernel kernel, std::shared_ptr<const PreconditionerPattern> pattern, std::span<const double> diagonal,
                   const Work& work = {});
    /// With the rows of `earlier` where they stay the same: its pattern may have further points, the diagonal other entries.
    Preconditioner(const Preconditioner& earlier, Kernel kernel, std::shared_ptr<const PreconditionerPattern> pattern,
                   const Diagonals& diagonals, const Work& work = {});

    const std::shared_ptr<const PreconditionerPattern>& pattern() const { return pattern_; }

    /// z = M^-1 r. The same bytes for any number of threads.
    void apply(std::span<const double> r, std::span<double> z) const;

    double megabytes() const;

private:
    template <class Task>
    void for_top_and_nodes(std::int64_t chunk, const Task& task) const;
    /// Only the top and the supernodes with points that have changed.
    void factorise(Kernel kernel, std::span<const double> diagonal, const std::vector<bool>& has_changed);
    void factorise_top(Kernel kernel, std::span<const double> diagonal);
    void factorise_node(Kernel kernel, const PreconditionerPattern::Supernode& node, std::span<const double> diagonal,
                        std::span<float> rows) const;

    std::shared_ptr<const PreconditionerPattern> pattern_;
    Work work_;
    std::vector<double> top_factor_;  ///< see small_cholesky
    double top_scale_ = 1;
    std::vector<std::size_t> rows_begin_;  ///< of every supernode in rows_
    std::vector<float> rows_;              ///< members x (neighbours + members) of every supernode, row major
};

/// Of the point that the last of `columns` names, what it is by the others: the weights of phi at these whose sum is nearest
/// to phi at that point.
std::vector<double> shares_of_neighbours(Kernel kernel, const PointArrays& points, std::span<const std::int32_t> columns,
                                         std::span<const double> diagonal);

}  // namespace kontur
