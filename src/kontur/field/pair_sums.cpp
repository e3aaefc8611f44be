// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/pair_sums.h"

#include <algorithm>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

// Compilers vectorise sums only where they may reorder them; vector types spell the order out.
constexpr int kLanes = 8;
using Pack = double __attribute__((vector_size(kLanes * sizeof(double)), aligned(sizeof(double))));
using HalfPack = double __attribute__((vector_size(kLanes / 2 * sizeof(double))));
using QuarterPack = double __attribute__((vector_size(kLanes / 4 * sizeof(double))));

[[gnu::always_inline]] inline void load(const double* from, Pack& pack) {
    for (int l = 0; l < kLanes; ++l) pack[l] = from[l];
}

[[gnu::always_inline]] inline double sum_of(const Pack& p) {
    const HalfPack half = __builtin_shufflevector(p, p, 0, 1, 2, 3) + __builtin_shufflevector(p, p, 4, 5, 6, 7);
    const QuarterPack quarter = __builtin_shufflevector(half, half, 0, 1) + __builtin_shufflevector(half, half, 2, 3);
    return quarter[0] + quarter[1];
}

template <Kernel kKernel>
[[gnu::always_inline]] inline void evaluate(const Pack& dx, const Pack& dy, const Pack& dz, Pack& phi) {
    const Pack squared = dx * dx + dy * dy + dz * dz;
    Pack r;
    for (int l = 0; l < kLanes; ++l) r[l] = std::sqrt(squared[l]);
    phi = kKernel == Kernel::triharmonic ? squared * r : r;
}

/// At most kPacks * kLanes left nodes, held in registers while the right ones pass by.
template <Kernel kKernel, bool kMutual, int kPacks>
[[gnu::always_inline]] inline void add_sums(const NodeView& nodes, NodeRun left, std::span<const NodeRun> right,
                                            double* out) {
    Pack x[kPacks], y[kPacks], z[kPacks], weight[kPacks], sum[kPacks];
    for (int p = 0; p < kPacks; ++p) {
        const std::int32_t first = left.begin + p * kLanes;
        load(nodes.x + first, x[p]);
        load(nodes.y + first, y[p]);
        load(nodes.z + first, z[p]);
        for (int l = 0; l < kLanes; ++l) weight[p][l] = first + l < left.end ? nodes.weight[first + l] : 0.0;
        sum[p] = Pack{};
    }
    for (const NodeRun& run : right)
        for (std::int32_t j = run.begin; j < run.end; ++j) {
            const double xj = nodes.x[j], yj = nodes.y[j], zj = nodes.z[j], wj = nodes.weight[j];
            Pack back{};
#pragma GCC unroll 4
            for (int p = 0; p < kPacks; ++p) {
                Pack phi;
                evaluate<kKernel>(x[p] - xj, y[p] - yj, z[p] - zj, phi);
                sum[p] += wj * phi;
                if constexpr (kMutual) back += weight[p] * phi;
            }
            if constexpr (kMutual) out[j] += sum_of(back);
        }
    for (int p = 0; p < kPacks; ++p)
        for (int l = 0; l < kLanes; ++l)
            if (const std::int32_t i = left.begin + p * kLanes + l; i < left.end) out[i] += sum[p][l];
}

template <Kernel kKernel, bool kMutual>
[[gnu::always_inline]] inline void add_all_sums(const NodeView& nodes, NodeRun left, std::span<const NodeRun> right,
                                                double* out) {
    constexpr int kMostPacks = 4;
    for (; left.begin < left.end; left.begin += kMostPacks * kLanes) {
        const NodeRun part{left.begin, std::min(left.end, left.begin + kMostPacks * kLanes)};
        if (part.size() > 3 * kLanes) add_sums<kKernel, kMutual, 4>(nodes, part, right, out);
        else if (part.size() > 2 * kLanes) add_sums<kKernel, kMutual, 3>(nodes, part, right, out);
        else if (part.size() > kLanes) add_sums<kKernel, kMutual, 2>(nodes, part, right, out);
        else add_sums<kKernel, kMutual, 1>(nodes, part, right, out);
    }
}

}  // namespace

KONTUR_EVERY_INSTRUCTION_SET void add_mutual_sums(Kernel kernel, const NodeView& nodes, NodeRun left,
                                                  std::span<const NodeRun> right, double* out) {
    if (kernel == Kernel::triharmonic) add_all_sums<Kernel::triharmonic, true>(nodes, left, right, out);
    else add_all_sums<Kernel::biharmonic, true>(nodes, left, right, out);
}

KONTUR_EVERY_INSTRUCTION_SET void add_own_sums(Kernel kernel, const NodeView& nodes, NodeRun run, double* out) {
    if (kernel == Kernel::triharmonic) add_all_sums<Kernel::triharmonic, false>(nodes, run, {&run, 1}, out);
    else add_all_sums<Kernel::biharmonic, false>(nodes, run, {&run, 1}, out);
}

}  // namespace kontur
