// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/preconditioner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/base/instruction_sets.h"
#include "kontur/base/parallel.h"
#include "kontur/function/screened_kernel.h"
#include "kontur/solve/small_cholesky.h"

namespace kontur {
namespace {

constexpr std::size_t kTop = static_cast<std::size_t>(-1);  // among the supernodes

/// Local coordinates of a few points: about their members' mean, scaled to radius 1, padded with zeros to whole registers.
struct LocalPoints {
    std::vector<double> x, y, z;
    double radius = 1;
};

/// The last `members` of the columns are the members.
void localise(const PointArrays& points, std::span<const std::int32_t> columns, std::int32_t members, LocalPoints& local) {
    const std::size_t n = columns.size();
    Vec3 mean;
    for (std::size_t i = n - static_cast<std::size_t>(members); i < n; ++i)
        mean += points[static_cast<std::size_t>(columns[i])];
    mean *= 1.0 / members;

    for (auto* axis : {&local.x, &local.y, &local.z})
        axis->assign(static_cast<std::size_t>(padded_rows(static_cast<int>(n))), 0.0);
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
}

/// phi on coordinates divided by `radius` is phi / degree_scale(radius).
double degree_scale(Kernel kernel, double radius) {
    return kernel == Kernel::biharmonic ? radius : radius * radius * radius;
}

/// What is added to sign phi: constant + linear x.y, on local coordinates.
struct PolynomialWeights {
    double constant, linear;
};

/// Such a part changes nothing on weights that satisfy the side conditions and makes the matrix definite on all others. The
/// screened kernel has one of its own: of its even powers 3 l^3 and 3 l x.y, as far as rounding leaves r^3 beside them.
PolynomialWeights polynomial_weights(Kernel kernel, double weight, double radius) {
    constexpr double kMost = 1e9;
    if (kernel != Kernel::screened) return {weight, weight};
    const double l = kScreeningLength / radius;
    return {std::min(3 * l * l * l, kMost), std::min(3 * l, kMost)};
}

/// Lower triangle of sign phi + polynomials, as small_cholesky wants it; r^3 stands for the screened kernel, whose further
/// powers are small among neighbours.
KONTUR_EVERY_INSTRUCTION_SET void fill_local(Kernel kernel, const LocalPoints& p, const PolynomialWeights& weights,
                                             double* __restrict a, int n) {
    const double *x = p.x.data(), *y = p.y.data(), *z = p.z.data();
    const bool cubic = kernel != Kernel::biharmonic;
    const int lead = padded_rows(n);
    for (int j = 0; j < n; ++j, a += lead) {
        const double xj = x[j], yj = y[j], zj = z[j];
        for (int i = j / 16 * 16; i < lead; ++i) {
            const double dx = x[i] - xj, dy = y[i] - yj, dz = z[i] - zj;
            const double r2 = dx * dx + dy * dy + dz * dz;
            const double signed_phi = std::sqrt(r2) * (cubic ? r2 : -1.0);
            a[i] = signed_phi + weights.constant + weights.linear * (x[i] * xj + y[i] * yj + z[i] * zj);
        }
    }
}

/// The same of the screened kernel itself.
KONTUR_EVERY_INSTRUCTION_SET void fill_screened(const LocalPoints& p, double* __restrict a, int n) {
    const double *x = p.x.data(), *y = p.y.data(), *z = p.z.data();
    const double l = kScreeningLength, radius = p.radius, scale = 1 / (radius * radius * radius);
    const int lead = padded_rows(n);
    for (int j = 0; j < n; ++j, a += lead) {
        const double xj = x[j], yj = y[j], zj = z[j];
        for (int i = j / 16 * 16; i < lead; ++i) {
            const double dx = x[i] - xj, dy = y[i] - yj, dz = z[i] - zj;
            const double r2 = radius * radius * (dx * dx + dy * dy + dz * dz), r = std::sqrt(r2);
            double even, odd, phi;
            screened_halves(kScreenedValue, r2, even, odd);
            screened_value(r2, r, even, odd, phi);
            a[i] = scale * (3 * l * l * l - 1.5 * l * r2 + phi);
        }
    }
}

/// Adds the points' own diagonal entries.
void add_diagonal(std::span<const double> diagonal, std::span<const std::int32_t> columns, double scale, double* a) {
    const auto n = static_cast<int>(columns.size());
    const auto stride = static_cast<std::size_t>(padded_rows(n)) + 1;
    for (std::size_t j = 0; j < columns.size(); ++j) a[j * stride] += diagonal[static_cast<std::size_t>(columns[j])] / scale;
}

/// out = rows^T rows in, for m rows of n.
KONTUR_EVERY_INSTRUCTION_SET void apply_rows(const float* rows, std::int32_t m, std::int32_t n, const double* in,
                                             double* __restrict out) {
    constexpr std::int32_t kLanes = 16;
    std::fill(out, out + n, 0.0);
    for (std::int32_t r = 0; r < m; ++r, rows += n) {
        double lanes[kLanes] = {};
        std::int32_t c = 0;
        for (; c + kLanes <= n; c += kLanes)
            for (std::int32_t l = 0; l < kLanes; ++l) lanes[l] += static_cast<double>(rows[c + l]) * in[c + l];
        for (std::int32_t l = 0; c < n; ++c, ++l) lanes[l] += static_cast<double>(rows[c]) * in[c];
        const double product = std::accumulate(lanes, lanes + kLanes, 0.0);
        for (c = 0; c < n; ++c) out[c] += static_cast<double>(rows[c]) * product;
    }
}

struct LocalKernel {
    Kernel kernel;
    double polynomial_weight;
};

/// Rows of the last `members` points in the inverse of the factor of these points' matrix; none where it has no factor.
std::vector<double> last_rows(const LocalKernel& of, const PointArrays& points, std::span<const std::int32_t> columns,
                              std::int32_t members, std::span<const double> diagonal) {
    const auto n = static_cast<int>(columns.size());
    LocalPoints local;
    localise(points, columns, members, local);
    const double scale = degree_scale(of.kernel, local.radius);
    std::vector<double> matrix(static_cast<std::size_t>(padded_rows(n)) * static_cast<std::size_t>(n));
    std::vector<double> rows(static_cast<std::size_t>(n) * static_cast<std::size_t>(members));
    fill_local(of.kernel, local, polynomial_weights(of.kernel, of.polynomial_weight, local.radius), matrix.data(), n);
    add_diagonal(diagonal, columns, scale, matrix.data());
    if (!small_cholesky(matrix.data(), n)) return {};
    last_rows_of_inverse(matrix.data(), n, members, rows.data());
    const double factor = 1 / std::sqrt(scale);
    for (double& v : rows) v *= factor;
    return rows;
}

}  // namespace

Preconditioner::Preconditioner(Kernel kernel, std::shared_ptr<const PreconditionerPattern> pattern,
                               std::span<const double> diagonal, const Work& work)
    : pattern_(std::move(pattern)), work_(work.untold()) {
    factorise(kernel, diagonal, std::vector<bool>(diagonal.size(), true));
}

Preconditioner::Preconditioner(const Preconditioner& earlier, Kernel kernel,
                               std::shared_ptr<const PreconditionerPattern> pattern, const Diagonals& diagonals,
                               const Work& work)
    : Preconditioner(earlier) {
    pattern_ = std::move(pattern);
    work_ = work.untold();
    std::vector<bool> has_changed(diagonals.now.size(), true);
    for (std::size_t i = 0; i < diagonals.earlier.size(); ++i) has_changed[i] = diagonals.now[i] != diagonals.earlier[i];
    factorise(kernel, diagonals.now, has_changed);
}

void Preconditioner::factorise(Kernel kernel, std::span<const double> diagonal, const std::vector<bool>& has_changed) {
    const std::vector<std::int32_t>& order = pattern_->order();
    std::vector<double> ordered;
    for (const std::int32_t point : order) ordered.push_back(diagonal[static_cast<std::size_t>(point)]);
    const auto changes = [&](std::int32_t point) { return has_changed[static_cast<std::size_t>(point)]; };

    const std::vector<PreconditionerPattern::Supernode>& nodes = pattern_->supernodes();
    rows_begin_.resize(nodes.size() + 1);
    for (std::size_t s = 0; s < nodes.size(); ++s)
        rows_begin_[s + 1] =
            rows_begin_[s] + static_cast<std::size_t>(nodes[s].members) * static_cast<std::size_t>(nodes[s].size());
    rows_.resize(rows_begin_.back());
    for_top_and_nodes(4, [&](std::size_t s) {
        work_.check();
        if (s == kTop) {
            if (std::any_of(order.begin(), order.begin() + pattern_->top(), changes)) factorise_top(kernel, ordered);
        } else if (std::ranges::any_of(pattern_->columns(nodes[s]),
                                       [&](std::int32_t i) { return changes(order[static_cast<std::size_t>(i)]); })) {
            factorise_node(kernel, nodes[s], ordered,
                           std::span(rows_).subspan(rows_begin_[s], rows_begin_[s + 1] - rows_begin_[s]));
        }
    });
}

/// Calls task(kTop) and task(s) for every supernode, in parallel.
template <class Task>
void Preconditioner::for_top_and_nodes(std::int64_t chunk, const Task& task) const {
    const auto nodes = static_cast<std::int64_t>(pattern_->supernodes().size());
    parallel_for(nodes + 1, chunk, work_, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin) task(begin == 0 ? kTop : static_cast<std::size_t>(begin - 1));
    });
}

void Preconditioner::factorise_top(Kernel kernel, std::span<const double> diagonal) {
    const int top = pattern_->top();
    std::vector<std::int32_t> columns(static_cast<std::size_t>(top));
    std::iota(columns.begin(), columns.end(), 0);
    LocalPoints local;
    localise(pattern_->points(), columns, top, local);
    const double scale = degree_scale(kernel, local.radius);
    top_scale_ = 1 / scale;
    top_factor_.resize(columns.size() * static_cast<std::size_t>(padded_rows(top)));
    if (kernel == Kernel::screened) fill_screened(local, top_factor_.data(), top);
    else
        fill_local(kernel, local, polynomial_weights(kernel, pattern_->options().polynomial_weight, local.radius),
                   top_factor_.data(), top);
    add_diagonal(diagonal, columns, scale, top_factor_.data());
    if (!small_cholesky(top_factor_.data(), top))
        throw Error(ErrorKind::singular_system,
                    "the coarse part of the system is not positive definite; constraints coincide");
}

/// A node that cannot be factorised keeps rows of zeros: no preconditioning of these points.
void Preconditioner::factorise_node(Kernel kernel, const PreconditionerPattern::Supernode& node,
                                    std::span<const double> diagonal, std::span<float> rows) const {
    const std::vector<double> inverse_rows = last_rows({kernel, pattern_->options().polynomial_weight}, pattern_->points(),
                                                       pattern_->columns(node), node.members, diagonal);
    std::ranges::fill(rows, 0.0F);
    std::ranges::transform(inverse_rows, rows.begin(), [](double v) { return static_cast<float>(v); });
}

std::vector<double> shares_of_neighbours(Kernel kernel, const PointArrays& points, std::span<const std::int32_t> columns,
                                         std::span<const double> diagonal) {
    std::vector<double> row = last_rows({kernel, PreconditionerOptions{}.polynomial_weight}, points, columns, 1, diagonal);
    if (row.empty()) return {};
    const double own = row.back();
    row.pop_back();
    for (double& v : row) v /= -own;
    return row;
}

void Preconditioner::apply(std::span<const double> r, std::span<double> z) const {
    const std::vector<std::int32_t>& order = pattern_->order();
    std::vector<double> ordered(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) ordered[i] = r[static_cast<std::size_t>(order[i])];

    // Every supernode writes its own contributions; every point then gathers its share of them in order.
    std::vector<double> top(ordered.begin(), ordered.begin() + pattern_->top());
    std::vector<double> contributions(pattern_->column_count());
    const auto& nodes = pattern_->supernodes();
    for_top_and_nodes(16, [&](std::size_t s) {
        if (s == kTop) return small_cholesky_solve(top_factor_.data(), pattern_->top(), top.data());
        const std::span<const std::int32_t> columns = pattern_->columns(nodes[s]);
        std::vector<double> in(columns.size());
        for (std::size_t c = 0; c < columns.size(); ++c) in[c] = ordered[static_cast<std::size_t>(columns[c])];
        apply_rows(&rows_[rows_begin_[s]], nodes[s].members, nodes[s].size(), in.data(), &contributions[nodes[s].columns]);
    });
    parallel_for(static_cast<std::int64_t>(order.size()), 4096, work_, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::int32_t>(begin); i < static_cast<std::int32_t>(end); ++i) {
            double sum = i < pattern_->top() ? top_scale_ * top[static_cast<std::size_t>(i)] : 0.0;
            for (const std::uint32_t at : pattern_->occurrences(i)) sum += contributions[at];
            z[static_cast<std::size_t>(order[static_cast<std::size_t>(i)])] = sum;
        }
    });
}

double Preconditioner::megabytes() const {
    return (static_cast<double>(top_factor_.size()) * 8 + static_cast<double>(rows_.size()) * 4 +
            static_cast<double>(pattern_->column_count()) * 8) /
           (1 << 20);
}

}  // namespace kontur
