// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/pair_sums.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/instruction_sets.h"
#include "kontur/function/root_by_estimate.h"
#include "kontur/function/screened_kernel.h"

// GCC 12 takes writing one lane of a vector for reading the others.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

namespace kontur {
namespace {

// Compilers vectorise sums only where they may reorder them; vector types spell the order out. A type wider than the
// processor's registers would be broken into single numbers, so each instruction set has its own number of lanes.
template <int kLanes>
struct PackOf;
template <>
struct PackOf<2> {
    using Type = double __attribute__((vector_size(2 * sizeof(double)), aligned(sizeof(double))));
};
template <>
struct PackOf<4> {
    using Type = double __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double))));
};
template <>
struct PackOf<8> {
    using Type = double __attribute__((vector_size(8 * sizeof(double)), aligned(sizeof(double))));
};
template <int kLanes>
using Pack = typename PackOf<kLanes>::Type;

template <int kLanes>
[[gnu::always_inline]] inline void load(const double* from, Pack<kLanes>& pack) {
    for (int l = 0; l < kLanes; ++l) pack[l] = from[l];
}

template <int kLanes>
[[gnu::always_inline]] inline double sum_of(const Pack<kLanes>& p) {
    if constexpr (kLanes == 2) {
        return p[0] + p[1];
    } else if constexpr (kLanes == 4) {
        return (p[0] + p[2]) + (p[1] + p[3]);
    } else {
        const Pack<4> half = __builtin_shufflevector(p, p, 0, 1, 2, 3) + __builtin_shufflevector(p, p, 4, 5, 6, 7);
        return sum_of<4>(half);
    }
}

/// The processor's own.
struct OwnRoot {
    template <class Pack>
    [[gnu::always_inline]] static void of(const Pack& squared, Pack& root) {
        for (std::size_t l = 0; l < sizeof(Pack) / sizeof(double); ++l) root[l] = std::sqrt(squared[l]);
    }
};

/// phi at some packs of squared distances, step by step for all of them: each step of one waits for the last.
template <Kernel kKernel, class Root, int kPacks, class Pack>
[[gnu::always_inline]] inline void evaluate(const Pack (&squared)[kPacks], Pack (&phi)[kPacks]) {
    Pack r[kPacks], even[kPacks], odd[kPacks];
#pragma GCC unroll 4
    for (int p = 0; p < kPacks; ++p) Root::of(squared[p], r[p]);
    if constexpr (kKernel == Kernel::screened) {
#pragma GCC unroll 4
        for (int p = 0; p < kPacks; ++p) screened_halves(kScreenedValue, squared[p], even[p], odd[p]);
    }
#pragma GCC unroll 4
    for (int p = 0; p < kPacks; ++p)
        if constexpr (kKernel == Kernel::screened) screened_value(squared[p], r[p], even[p], odd[p], phi[p]);
        else phi[p] = kKernel == Kernel::triharmonic ? squared[p] * r[p] : r[p];
}

/// At most kPacks * kLanes left nodes, held in registers while the right ones pass by.
template <int kLanes, class Root, Kernel kKernel, bool kMutual, int kPacks>
[[gnu::always_inline]] inline void add_sums(const NodeView& nodes, NodeRun left, std::span<const NodeRun> right,
                                            double* out) {
    Pack<kLanes> x[kPacks], y[kPacks], z[kPacks], weight[kPacks], sum[kPacks];
    for (int p = 0; p < kPacks; ++p) {
        const std::int32_t first = left.begin + p * kLanes;
        load<kLanes>(nodes.x + first, x[p]);
        load<kLanes>(nodes.y + first, y[p]);
        load<kLanes>(nodes.z + first, z[p]);
        for (int l = 0; l < kLanes; ++l) weight[p][l] = first + l < left.end ? nodes.weight[first + l] : 0.0;
        sum[p] = Pack<kLanes>{};
    }
    for (const NodeRun& run : right)
        for (std::int32_t j = run.begin; j < run.end; ++j) {
            const double xj = nodes.x[j], yj = nodes.y[j], zj = nodes.z[j], wj = nodes.weight[j];
            Pack<kLanes> squared[kPacks], phi[kPacks], back{};
#pragma GCC unroll 4
            for (int p = 0; p < kPacks; ++p) {
                const Pack<kLanes> dx = x[p] - xj, dy = y[p] - yj, dz = z[p] - zj;
                squared[p] = dx * dx + dy * dy + dz * dz;
            }
            evaluate<kKernel, Root>(squared, phi);
#pragma GCC unroll 4
            for (int p = 0; p < kPacks; ++p) {
                sum[p] += wj * phi[p];
                if constexpr (kMutual) back += weight[p] * phi[p];
            }
            if constexpr (kMutual) out[j] += sum_of<kLanes>(back);
        }
    for (int p = 0; p < kPacks; ++p)
        for (int l = 0; l < kLanes; ++l)
            if (const std::int32_t i = left.begin + p * kLanes + l; i < left.end) out[i] += sum[p][l];
}

template <int kLanes, class Root, Kernel kKernel, bool kMutual>
[[gnu::always_inline]] inline void add_all_sums(const NodeView& nodes, NodeRun left, std::span<const NodeRun> right,
                                                double* out) {
    constexpr int kMostPacks = 4;
    for (; left.begin < left.end; left.begin += kMostPacks * kLanes) {
        const NodeRun part{left.begin, std::min(left.end, left.begin + kMostPacks * kLanes)};
        if (part.size() > 3 * kLanes) add_sums<kLanes, Root, kKernel, kMutual, 4>(nodes, part, right, out);
        else if (part.size() > 2 * kLanes) add_sums<kLanes, Root, kKernel, kMutual, 3>(nodes, part, right, out);
        else if (part.size() > kLanes) add_sums<kLanes, Root, kKernel, kMutual, 2>(nodes, part, right, out);
        else add_sums<kLanes, Root, kKernel, kMutual, 1>(nodes, part, right, out);
    }
}

template <int kLanes, class Root, bool kMutual>
[[gnu::always_inline]] inline void add_sums_of(Kernel kernel, const NodeView& nodes, NodeRun left,
                                               std::span<const NodeRun> right, double* out) {
    if (kernel == Kernel::screened) add_all_sums<kLanes, Root, Kernel::screened, kMutual>(nodes, left, right, out);
    else if (kernel == Kernel::triharmonic)
        add_all_sums<kLanes, Root, Kernel::triharmonic, kMutual>(nodes, left, right, out);
    else add_all_sums<kLanes, Root, Kernel::biharmonic, kMutual>(nodes, left, right, out);
}

using AddSums = void(Kernel, const NodeView&, NodeRun, std::span<const NodeRun>, double*);

template <bool kMutual>
void add_sums_by_2(Kernel kernel, const NodeView& nodes, NodeRun left, std::span<const NodeRun> right, double* out) {
    add_sums_of<2, OwnRoot, kMutual>(kernel, nodes, left, right, out);
}

#if KONTUR_X86_64_LEVEL == 1
template <bool kMutual>
AddSums* widest() {
    return add_sums_by_2<kMutual>;
}
#else
template <bool kMutual>
__attribute__((target("arch=x86-64-v3"))) void add_sums_by_4(Kernel kernel, const NodeView& nodes, NodeRun left,
                                                             std::span<const NodeRun> right, double* out) {
    add_sums_of<4, OwnRoot, kMutual>(kernel, nodes, left, right, out);
}

template <bool kMutual>
__attribute__((target("arch=x86-64-v4"))) void add_sums_by_8(Kernel kernel, const NodeView& nodes, NodeRun left,
                                                             std::span<const NodeRun> right, double* out) {
    add_sums_of<8, OwnRoot, kMutual>(kernel, nodes, left, right, out);
}

struct EstimatedRoot {
    [[gnu::always_inline]] static void of(const Pack8& squared, Pack8& root) { root_by_estimate(squared, root); }
};

template <bool kMutual>
__attribute__((target("arch=x86-64-v4"))) void add_sums_by_estimate(Kernel kernel, const NodeView& nodes, NodeRun left,
                                                                    std::span<const NodeRun> right, double* out) {
    add_sums_of<8, EstimatedRoot, kMutual>(kernel, nodes, left, right, out);
}

template <bool kMutual>
AddSums* widest() {
    if (gains_by_estimate()) return add_sums_by_estimate<kMutual>;
    const int level = x86_64_level();
    return level == 4 ? add_sums_by_8<kMutual> : level == 3 ? add_sums_by_4<kMutual> : add_sums_by_2<kMutual>;
}
#endif

}  // namespace

void add_mutual_sums(Kernel kernel, const NodeView& nodes, NodeRun left, std::span<const NodeRun> right, double* out) {
    static AddSums* const add = widest<true>();
    add(kernel, nodes, left, right, out);
}

void add_own_sums(Kernel kernel, const NodeView& nodes, NodeRun run, double* out) {
    static AddSums* const add = widest<false>();
    add(kernel, nodes, run, {&run, 1}, out);
}

}  // namespace kontur
