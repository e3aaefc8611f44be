// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/preconditioner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "kontur/base/error.h"
#include "kontur/base/instruction_sets.h"
#include "kontur/base/parallel.h"
#include "kontur/field/small_cholesky.h"

namespace kontur {
namespace {

constexpr int kDeepestLevel = 21;

/// Bits of v moved to every third position.
std::uint64_t spread_bits(std::uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    return (v | v << 2) & 0x1249249249249249ull;
}

struct CodedPoint {
    std::uint64_t morton;
    std::int32_t point;
    bool taken = false;
};

double squared_distance(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

/// The points seen by the kd-tree library.
struct Cloud {
    const PointArrays& points;
    std::size_t count;
    std::size_t kdtree_get_point_count() const { return count; }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        return axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};
using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 3, std::uint32_t>;

/// A nanoflann result set: the nearest `capacity` points whose position in order is below `limit`.
class EarlierNeighbours {
public:
    EarlierNeighbours(std::size_t capacity, std::uint32_t limit) : capacity_(capacity), limit_(limit) {}

    using Candidate = std::pair<double, std::uint32_t>;
    std::size_t size() const { return heap_.size(); }
    bool full() const { return heap_.size() == capacity_; }
    double worstDist() const { return full() ? heap_.front().first : std::numeric_limits<double>::max(); }
    bool addPoint(double distance, std::uint32_t index) {
        if (index >= limit_) return true;
        heap_.emplace_back(distance, index);
        std::push_heap(heap_.begin(), heap_.end());
        if (heap_.size() > capacity_) {
            std::pop_heap(heap_.begin(), heap_.end());
            heap_.pop_back();
        }
        return true;
    }
    std::vector<Candidate>& candidates() { return heap_; }

private:
    std::size_t capacity_;
    std::uint32_t limit_;
    std::vector<Candidate> heap_;
};

/// Local coordinates of a few points: about their members' mean, scaled to radius 1.
struct LocalPoints {
    std::vector<double> x, y, z;
    double radius = 1;
};

LocalPoints local_points(const PointArrays& points, std::span<const std::int32_t> columns, std::size_t members) {
    const std::size_t n = columns.size();
    Vec3 mean;
    for (std::size_t i = n - members; i < n; ++i) mean += points[static_cast<std::size_t>(columns[i])];
    mean *= 1.0 / static_cast<double>(members);

    LocalPoints local{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 d = points[static_cast<std::size_t>(columns[i])] - mean;
        largest = std::max(largest, dot(d, d));
        local.x[i] = d.x;
        local.y[i] = d.y;
        local.z[i] = d.z;
    }
    local.radius = largest > 0 ? std::sqrt(largest) : 1;
    for (auto* axis : {&local.x, &local.y, &local.z})
        for (double& v : *axis) v /= local.radius;
    return local;
}

/// phi on coordinates divided by `radius` is phi / degree_scale(radius).
double degree_scale(Kernel kernel, double radius) {
    return kernel == Kernel::triharmonic ? radius * radius * radius : radius;
}

/// column[i] = sign phi(|p_i - p_j|) + weight (1 + p_i . p_j) for i from j on.
KONTUR_EVERY_INSTRUCTION_SET void fill_column(Kernel kernel, const LocalPoints& p, double weight, int j, int n,
                                              double* __restrict column) {
    const double *x = p.x.data(), *y = p.y.data(), *z = p.z.data();
    const double xj = x[j], yj = y[j], zj = z[j];
    const bool cubic = kernel == Kernel::triharmonic;
    for (int i = j; i < n; ++i) {
        const double dx = x[i] - xj, dy = y[i] - yj, dz = z[i] - zj;
        const double r2 = dx * dx + dy * dy + dz * dz;
        const double signed_phi = std::sqrt(r2) * (cubic ? r2 : -1.0);
        column[i] = signed_phi + weight * (1 + (x[i] * xj + y[i] * yj + z[i] * zj));
    }
}

/// Lower triangle of sign phi + weight (1 + x.y) + diagonal I, column major. The polynomial part changes nothing on weights
/// that satisfy the side conditions and makes the matrix definite on all others.
void fill_local(Kernel kernel, const LocalPoints& p, double diagonal, double polynomial_weight, double* a, int n) {
    for (int j = 0; j < n; ++j) {
        double* column = a + static_cast<std::ptrdiff_t>(j) * n;
        fill_column(kernel, p, polynomial_weight, j, n, column);
        column[j] += diagonal;
    }
}

}  // namespace

MultiscaleOrder multiscale_order(const PointArrays& points) {
    const std::size_t n = points.size();
    Box3 box;
    for (std::size_t i = 0; i < n; ++i) box.extend(points[i]);
    const Vec3 extent = box.size();
    const double side = std::max({extent.x, extent.y, extent.z, 1e-300}) * (1 + 1e-9);
    const double to_cell = (1 << kDeepestLevel) / side;
    const auto cell = [&](double v, double low) { return static_cast<std::uint64_t>((v - low) * to_cell); };

    std::vector<CodedPoint> coded(n);
    for (std::size_t i = 0; i < n; ++i)
        coded[i] = {spread_bits(cell(points.x[i], box.min.x)) | spread_bits(cell(points.y[i], box.min.y)) << 1 |
                        spread_bits(cell(points.z[i], box.min.z)) << 2,
                    static_cast<std::int32_t>(i)};
    std::sort(coded.begin(), coded.end(), [](const CodedPoint& a, const CodedPoint& b) {
        return a.morton != b.morton ? a.morton < b.morton : a.point < b.point;
    });

    MultiscaleOrder result;
    result.order.reserve(n);
    result.level_begin.push_back(0);
    for (int level = 1; level <= kDeepestLevel && result.order.size() < n; ++level) {
        const double width = side / (1 << level);
        const int shift = 3 * (kDeepestLevel - level);
        std::size_t next = 0;
        for (std::size_t begin = 0; begin < n; begin = next) {
            bool covered = false;
            for (next = begin; next < n && coded[next].morton >> shift == coded[begin].morton >> shift; ++next)
                covered |= coded[next].taken;
            if (covered) continue;
            // The cell's point nearest to its centre represents it.
            Vec3 center;
            const Vec3 any = points[static_cast<std::size_t>(coded[begin].point)];
            for (int axis = 0; axis < 3; ++axis)
                center[axis] = box.min[axis] + (std::floor((any[axis] - box.min[axis]) / width) + 0.5) * width;
            std::size_t best = begin;
            double best_distance = std::numeric_limits<double>::infinity();
            for (std::size_t q = begin; q < next; ++q) {
                const double d = squared_distance(points[static_cast<std::size_t>(coded[q].point)], center);
                if (d < best_distance) {
                    best_distance = d;
                    best = q;
                }
            }
            coded[best].taken = true;
            result.order.push_back(coded[best].point);
        }
        result.level_begin.push_back(static_cast<std::int32_t>(result.order.size()));
        result.spacing.push_back(width);
    }
    if (result.order.size() < n) {  // points closer than the deepest level resolves
        for (const CodedPoint& c : coded)
            if (!c.taken) result.order.push_back(c.point);
        result.level_begin.push_back(static_cast<std::int32_t>(n));
        result.spacing.push_back(result.spacing.back());
    }
    return result;
}

Preconditioner::Preconditioner(Kernel kernel, const PointArrays& points, double diagonal,
                               const PreconditionerOptions& options, int threads) {
    const MultiscaleOrder order = multiscale_order(points);
    order_ = order.order;
    std::vector<Vec3> sorted;
    sorted.reserve(order_.size());
    for (const std::int32_t i : order_) sorted.push_back(points[static_cast<std::size_t>(i)]);
    points_ = PointArrays(sorted);
    top_ = std::min(static_cast<std::int32_t>(order_.size()), options.dense_top);

    factorise_top(kernel, diagonal, options);
    cut_into_supernodes(order, options);
    find_neighbours(order, options, threads);
    factorise_supernodes(kernel, diagonal, options, threads);
}

void Preconditioner::cut_into_supernodes(const MultiscaleOrder& order, const PreconditionerOptions& options) {
    for (std::size_t level = 0; level + 1 < order.level_begin.size(); ++level) {
        const std::int32_t level_end = order.level_begin[level + 1];
        const double widest = 12 * order.spacing[level];  // members farther apart would share too few neighbours
        for (std::int32_t begin = std::max(order.level_begin[level], top_); begin < level_end;) {
            Box3 box;
            std::int32_t end = begin;
            while (end < level_end && end - begin < options.supernode) {
                Box3 grown = box;
                grown.extend(points_[static_cast<std::size_t>(end)]);
                const Vec3 size = grown.size();
                if (end > begin && std::max({size.x, size.y, size.z}) > widest) break;
                box = grown;
                ++end;
            }
            supernodes_.push_back({begin, end - begin, 0, 0, 0});
            begin = end;
        }
    }
}

void Preconditioner::find_neighbours(const MultiscaleOrder& order, const PreconditionerOptions& options, int threads) {
    std::vector<std::vector<std::int32_t>> found(supernodes_.size());
    std::size_t first = 0;
    for (std::size_t level = 0; level + 1 < order.level_begin.size(); ++level) {
        const std::int32_t level_end = order.level_begin[level + 1];
        std::size_t last = first;
        while (last < supernodes_.size() && supernodes_[last].begin < level_end) ++last;
        if (last == first) continue;
        // A tree of this level and all coarser ones; finer points would only be in the way.
        const Cloud cloud{points_, static_cast<std::size_t>(level_end)};
        const KdTree tree(3, cloud, {16});
        parallel_for(static_cast<std::int64_t>(last - first), 8, threads, [&](std::int64_t begin, std::int64_t end) {
            for (auto s = first + static_cast<std::size_t>(begin); s < first + static_cast<std::size_t>(end); ++s) {
                const Supernode& node = supernodes_[s];
                Vec3 mean;
                for (std::int32_t m = 0; m < node.members; ++m) mean += points_[static_cast<std::size_t>(node.begin + m)];
                mean *= 1.0 / node.members;
                // Nearest to the mean first, with some to spare; then those nearest to any member.
                EarlierNeighbours nearest(2 * static_cast<std::size_t>(options.neighbours),
                                          static_cast<std::uint32_t>(node.begin));
                const std::array<double, 3> query{mean.x, mean.y, mean.z};
                tree.findNeighbors(nearest, query.data(), {});
                auto& candidates = nearest.candidates();
                for (auto& [d, index] : candidates) {
                    d = std::numeric_limits<double>::infinity();
                    for (std::int32_t m = 0; m < node.members; ++m)
                        d = std::min(d, squared_distance(points_[index], points_[static_cast<std::size_t>(node.begin + m)]));
                }
                std::sort(candidates.begin(), candidates.end());
                if (candidates.size() > static_cast<std::size_t>(options.neighbours))
                    candidates.resize(static_cast<std::size_t>(options.neighbours));
                for (const auto& [d, index] : candidates) found[s].push_back(static_cast<std::int32_t>(index));
                std::sort(found[s].begin(), found[s].end());
            }
        });
        first = last;
    }
    std::size_t rows = 0;
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
        Supernode& node = supernodes_[s];
        node.neighbours = static_cast<std::int32_t>(found[s].size());
        node.columns = columns_.size();
        node.rows = rows;
        columns_.insert(columns_.end(), found[s].begin(), found[s].end());
        for (std::int32_t m = 0; m < node.members; ++m) columns_.push_back(node.begin + m);
        rows += static_cast<std::size_t>(node.members) * static_cast<std::size_t>(node.neighbours + node.members);
    }
    rows_.resize(rows);
}

void Preconditioner::factorise_top(Kernel kernel, double diagonal, const PreconditionerOptions& options) {
    std::vector<std::int32_t> columns(static_cast<std::size_t>(top_));
    for (std::int32_t i = 0; i < top_; ++i) columns[static_cast<std::size_t>(i)] = i;
    const LocalPoints local = local_points(points_, columns, columns.size());
    const double scale = degree_scale(kernel, local.radius);
    top_scale_ = 1 / scale;
    top_factor_.resize(columns.size() * columns.size());
    fill_local(kernel, local, diagonal / scale, options.polynomial_weight, top_factor_.data(), top_);
    if (!small_cholesky(top_factor_.data(), top_, top_))
        throw Error(ErrorKind::singular_system,
                    "the coarse part of the system is not positive definite; constraints coincide");
}

void Preconditioner::factorise_supernodes(Kernel kernel, double diagonal, const PreconditionerOptions& options,
                                          int threads) {
    parallel_for(static_cast<std::int64_t>(supernodes_.size()), 4, threads, [&](std::int64_t begin, std::int64_t end) {
        std::vector<double> matrix, inverse_rows;
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s) {
            const Supernode& node = supernodes_[s];
            const int n = node.neighbours + node.members;
            const LocalPoints local = local_points(points_, {&columns_[node.columns], static_cast<std::size_t>(n)},
                                                   static_cast<std::size_t>(node.members));
            const double scale = degree_scale(kernel, local.radius);
            matrix.resize(static_cast<std::size_t>(n) * n);
            inverse_rows.resize(static_cast<std::size_t>(n) * node.members);
            fill_local(kernel, local, diagonal / scale, options.polynomial_weight, matrix.data(), n);
            if (!small_cholesky(matrix.data(), n, n)) continue;  // its rows stay zero: no preconditioning of these points
            last_rows_of_inverse(matrix.data(), n, n, node.members, inverse_rows.data());
            const double factor = 1 / std::sqrt(scale);
            for (std::size_t e = 0; e < inverse_rows.size(); ++e)
                rows_[node.rows + e] = static_cast<float>(inverse_rows[e] * factor);
        }
    });
}

void Preconditioner::apply(std::span<const double> r, std::span<double> z, int threads) const {
    std::vector<double> ordered(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) ordered[i] = r[static_cast<std::size_t>(order_[i])];

    std::vector<double> result(order_.size(), 0.0);
    std::copy_n(ordered.begin(), top_, result.begin());
    small_cholesky_solve(top_factor_.data(), top_, top_, result.data());
    for (std::int32_t i = 0; i < top_; ++i) result[static_cast<std::size_t>(i)] *= top_scale_;

    // Every supernode writes its own contributions; they are added in order afterwards, whatever thread made them.
    std::vector<double> contributions(columns_.size());
    parallel_for(static_cast<std::int64_t>(supernodes_.size()), 32, threads, [&](std::int64_t begin, std::int64_t end) {
        std::vector<double> local;
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s) {
            const Supernode& node = supernodes_[s];
            const auto n = static_cast<std::size_t>(node.neighbours + node.members);
            local.resize(n);
            for (std::size_t c = 0; c < n; ++c) local[c] = ordered[static_cast<std::size_t>(columns_[node.columns + c])];
            double* __restrict out = &contributions[node.columns];
            for (std::int32_t m = 0; m < node.members; ++m) {
                const float* row = &rows_[node.rows + static_cast<std::size_t>(m) * n];
                double product = 0;
                for (std::size_t c = 0; c < n; ++c) product += static_cast<double>(row[c]) * local[c];
                for (std::size_t c = 0; c < n; ++c) out[c] += static_cast<double>(row[c]) * product;
            }
        }
    });
    for (std::size_t c = 0; c < columns_.size(); ++c) result[static_cast<std::size_t>(columns_[c])] += contributions[c];
    for (std::size_t i = 0; i < order_.size(); ++i) z[static_cast<std::size_t>(order_[i])] = result[i];
}

double Preconditioner::megabytes() const {
    return (static_cast<double>(top_factor_.size()) * 8 + static_cast<double>(rows_.size()) * 4 +
            static_cast<double>(columns_.size()) * 4) /
           (1 << 20);
}

}  // namespace kontur
