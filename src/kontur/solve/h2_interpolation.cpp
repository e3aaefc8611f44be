// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/h2_interpolation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

// Sums run in lanes of a vector type, because compilers do not reorder sums; AVX2 would break a wider one into numbers.
constexpr int kLanes = 4;
using Pack = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(sizeof(double)), may_alias));
static_assert(kRowsPerStep % (2 * kLanes) == 0);

[[gnu::always_inline]] inline double sum_of(const Pack& p) { return (p[0] + p[2]) + (p[1] + p[3]); }

KONTUR_EVERY_INSTRUCTION_SET double squared_norm(const double* a, std::int32_t lead) {
    Pack sum{};
    for (std::int32_t i = 0; i < lead; i += kLanes) {
        const Pack& v = *reinterpret_cast<const Pack*>(a + i);
        sum += v * v;
    }
    return sum_of(sum);
}

KONTUR_EVERY_INSTRUCTION_SET void scale(double* a, std::int32_t lead, double factor) {
    for (std::int32_t i = 0; i < lead; ++i) a[i] *= factor;
}

/// Columns of a matrix, `lead` apart.
struct Columns {
    double* first;
    std::int32_t lead, count;
};

/// Removes the unit vector q from the columns a: gives q.a before, `stride` apart, and a.a after.
KONTUR_EVERY_INSTRUCTION_SET void remove(const double* q, const Columns& columns, double* products, std::int32_t stride,
                                         double* squares) {
    const std::int32_t lead = columns.lead;
    double* a = columns.first;
    for (std::int32_t j = 0; j < columns.count; ++j, a += lead) {
        Pack sum0{}, sum1{};
        for (std::int32_t i = 0; i < lead; i += 2 * kLanes) {
            const auto *u = reinterpret_cast<const Pack*>(q + i), *v = reinterpret_cast<const Pack*>(a + i);
            sum0 += u[0] * v[0];
            sum1 += u[1] * v[1];
        }
        const double product = sum_of(sum0 + sum1);
        products[static_cast<std::ptrdiff_t>(j) * stride] = product;
        Pack square0{}, square1{};
        for (std::int32_t i = 0; i < lead; i += 2 * kLanes) {
            const auto* u = reinterpret_cast<const Pack*>(q + i);
            auto* v = reinterpret_cast<Pack*>(a + i);
            v[0] -= product * u[0];
            v[1] -= product * u[1];
            square0 += v[0] * v[0];
            square1 += v[1] * v[1];
        }
        squares[j] = sum_of(square0 + square1);
    }
}

/// T = R11^-1 R12 for the triangle whose row k of column j is r[j * columns + k].
KONTUR_EVERY_INSTRUCTION_SET std::vector<double> transfer_of(const std::vector<double>& r, std::int32_t rank,
                                                             std::int32_t columns) {
    std::vector<double> transfer(static_cast<std::size_t>(rank) * static_cast<std::size_t>(columns - rank));
    for (std::int32_t j = rank; j < columns; ++j) {
        double* t = &transfer[static_cast<std::size_t>(j - rank) * static_cast<std::size_t>(rank)];
        std::copy_n(&r[static_cast<std::size_t>(j) * columns], rank, t);
        for (std::int32_t k = rank - 1; k >= 0; --k) {
            const double* column = &r[static_cast<std::size_t>(k) * columns];
            t[k] /= column[k];
            for (std::int32_t i = 0; i < k; ++i) t[i] -= t[k] * column[i];
        }
    }
    return transfer;
}

}  // namespace

Interpolation interpolate_columns(double* a, std::int32_t rows, std::int32_t lead, std::int32_t columns, double tolerance) {
    Interpolation result;
    result.columns.resize(static_cast<std::size_t>(columns));
    std::iota(result.columns.begin(), result.columns.end(), 0);
    const auto column = [&](std::int32_t j) { return a + static_cast<std::ptrdiff_t>(j) * lead; };
    std::vector<double> squares(static_cast<std::size_t>(columns));
    for (std::int32_t j = 0; j < columns; ++j) squares[static_cast<std::size_t>(j)] = squared_norm(column(j), lead);

    std::vector<double> r(static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns));
    const double enough = tolerance * tolerance * rows;
    for (std::int32_t k = 0; k < std::min(rows, columns); ++k) {
        const auto pivot = static_cast<std::int32_t>(std::max_element(squares.begin() + k, squares.end()) - squares.begin());
        if (!(squares[static_cast<std::size_t>(pivot)] > enough)) break;
        if (pivot != k) {
            std::swap_ranges(column(k), column(k) + lead, column(pivot));
            std::swap_ranges(&r[static_cast<std::size_t>(k) * columns], &r[static_cast<std::size_t>(k) * columns] + k,
                             &r[static_cast<std::size_t>(pivot) * columns]);
            std::swap(squares[static_cast<std::size_t>(k)], squares[static_cast<std::size_t>(pivot)]);
            std::swap(result.columns[static_cast<std::size_t>(k)], result.columns[static_cast<std::size_t>(pivot)]);
        }
        const double length = std::sqrt(squares[static_cast<std::size_t>(k)]);
        scale(column(k), lead, 1 / length);
        r[static_cast<std::size_t>(k) * columns + k] = length;
        if (k + 1 < columns)
            remove(column(k), {column(k + 1), lead, columns - k - 1}, &r[static_cast<std::size_t>(k + 1) * columns + k],
                   columns, &squares[k + 1]);
        result.rank = k + 1;
    }
    result.transfer = transfer_of(r, result.rank, columns);
    return result;
}

KONTUR_EVERY_INSTRUCTION_SET void condense(const Interpolation& interpolation, const double* candidates,
                                           double* __restrict skeleton) {
    const std::int32_t rank = interpolation.rank;
    for (std::int32_t k = 0; k < rank; ++k) skeleton[k] = candidates[interpolation.columns[static_cast<std::size_t>(k)]];
    const double* t = interpolation.transfer.data();
    for (auto j = static_cast<std::size_t>(rank); j < interpolation.columns.size(); ++j, t += rank) {
        const double weight = candidates[interpolation.columns[j]];
        for (std::int32_t k = 0; k < rank; ++k) skeleton[k] += weight * t[k];
    }
}

KONTUR_EVERY_INSTRUCTION_SET void expand(const Interpolation& interpolation, const double* skeleton,
                                         double* __restrict candidates) {
    constexpr std::int32_t kStep = 8;
    const std::int32_t rank = interpolation.rank, whole = rank / kStep * kStep;
    for (std::int32_t k = 0; k < rank; ++k) candidates[interpolation.columns[static_cast<std::size_t>(k)]] += skeleton[k];
    const double* t = interpolation.transfer.data();
    for (auto j = static_cast<std::size_t>(rank); j < interpolation.columns.size(); ++j, t += rank) {
        double lanes[kStep] = {};
        for (std::int32_t k = 0; k < whole; k += kStep)
            for (std::int32_t l = 0; l < kStep; ++l) lanes[l] += skeleton[k + l] * t[k + l];
        for (std::int32_t k = whole; k < rank; ++k) lanes[k - whole] += skeleton[k] * t[k];
        candidates[interpolation.columns[j]] +=
            ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
    }
}

ProxyShells::ProxyShells(std::int32_t most, double reach) : reach_(reach) {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
    // Most of them near, where a field varies most; prefixes of the list have the same mixture.
    constexpr double kOutward[] = {0, 0.1, 0, 0.25, 0, 0.1, 0.5, 0, 0.1, 0.25, 0, 1};
    for (std::int32_t p = 0; p < most; ++p) {
        Vec3 on_cube{2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1};
        on_cube[p % 3] = on_cube[p % 3] < 0 ? -1 : 1;
        proxies_.push_back({on_cube, kOutward[static_cast<std::size_t>(p) % std::size(kOutward)], uniform()});
    }
}

PointArrays ProxyShells::around(const Cluster& cluster, double nearest, std::int32_t count) const {
    PointArrays result;
    for (auto* axis : {&result.x, &result.y, &result.z}) axis->resize(static_cast<std::size_t>(count));
    const double ratio = std::log(std::max(reach_ / nearest, 1.0));
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        const Proxy& proxy = proxies_[i];
        const double distance = nearest * std::exp(ratio * proxy.outward) * (1 + 0.3 * proxy.jitter);
        Vec3 outside, inside;
        for (int axis = 0; axis < 3; ++axis) {
            const double half = cluster.half[axis];
            outside[axis] = proxy.on_cube[axis] * (half + distance);
            inside[axis] = std::clamp(outside[axis], -half, half);
        }
        const Vec3 point = cluster.center + inside + distance * normalized(outside - inside);
        result.x[i] = point.x;
        result.y[i] = point.y;
        result.z[i] = point.z;
    }
    return result;
}

}  // namespace kontur
