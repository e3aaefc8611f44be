// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/kernel_sums.h"

#include <algorithm>
#include <array>

#include "kontur/base/instruction_sets.h"
#include "kontur/base/parallel.h"
#include "kontur/function/root_by_estimate.h"

namespace kontur {
namespace {

// Targets that are summed side by side in vector registers: the lanes are targets, never terms of one sum.
constexpr int kLanes = 32;
constexpr std::int64_t kTargetsPerChunk = std::int64_t{4} * kLanes;

struct Lanes {
    alignas(64) std::array<double, kLanes> x{}, y{}, z{};
};

struct Sources {
    const double *x, *y, *z, *w;
    std::size_t count;
};

/// The sums of phi(r^2, r). Inlined into one function for each kernel, so that each is compiled for every instruction set.
template <class Phi>
[[gnu::always_inline]] inline void sum_terms(const Sources& s, const Lanes& t, double* __restrict out) {
    alignas(64) double sum[kLanes] = {};
    for (std::size_t j = 0; j < s.count; ++j) {
        const double sx = s.x[j], sy = s.y[j], sz = s.z[j], w = s.w[j];
        for (int l = 0; l < kLanes; ++l) {
            const double dx = t.x[l] - sx, dy = t.y[l] - sy, dz = t.z[l] - sz;
            const double r2 = dx * dx + dy * dy + dz * dz;
            sum[l] += w * Phi::at(r2, std::sqrt(r2));
        }
    }
    for (int l = 0; l < kLanes; ++l) out[l] = sum[l];
}

struct Triharmonic {
    [[gnu::always_inline]] static double at(double r2, double r) { return r2 * r; }
};
struct Biharmonic {
    [[gnu::always_inline]] static double at(double, double r) { return r; }
};
struct ScreenedNear {
    [[gnu::always_inline]] static double at(double r2, double r) {
        double even, odd, value;
        screened_halves(kScreenedValue, r2, even, odd);
        screened_value(r2, r, even, odd, value);
        return value;
    }
};
struct ScreenedFar {
    [[gnu::always_inline]] static double at(double, double r) { return screened_kernel_far(r); }
};

KONTUR_EVERY_INSTRUCTION_SET void sum_triharmonic(const Sources& s, const Lanes& t, double* __restrict out) {
    sum_terms<Triharmonic>(s, t, out);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_screened(const Sources& s, const Lanes& t, double* __restrict out) {
    sum_terms<ScreenedNear>(s, t, out);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_screened_far(const Sources& s, const Lanes& t, double* __restrict out) {
    sum_terms<ScreenedFar>(s, t, out);
}

/// With two weights for each centre.
KONTUR_EVERY_INSTRUCTION_SET void sum_screened_far_twice(const Sources& s, const double* second, const Lanes& t,
                                                         double* __restrict out, double* __restrict second_out) {
    alignas(64) double sum[kLanes] = {}, second_sum[kLanes] = {};
    for (std::size_t j = 0; j < s.count; ++j) {
        const double sx = s.x[j], sy = s.y[j], sz = s.z[j], w = s.w[j], w2 = second[j];
        for (int l = 0; l < kLanes; ++l) {
            const double dx = t.x[l] - sx, dy = t.y[l] - sy, dz = t.z[l] - sz;
            const double k = screened_kernel_far(std::sqrt(dx * dx + dy * dy + dz * dz));
            sum[l] += w * k;
            second_sum[l] += w2 * k;
        }
    }
    std::copy_n(sum, kLanes, out);
    std::copy_n(second_sum, kLanes, second_out);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_biharmonic(const Sources& s, const Lanes& t, double* __restrict out) {
    sum_terms<Biharmonic>(s, t, out);
}

// phi'(r) / r is 3 r for r^3 and 1 / r for r.
/// The gradients, and in `out` the values where they are wanted, too.
template <bool kScreened, bool kWithValues>
[[gnu::always_inline]] inline void sum_cube_slopes(const Sources& s, const Lanes& t, double* __restrict out, Lanes& slope) {
    alignas(64) double sum[kLanes] = {}, gx[kLanes] = {}, gy[kLanes] = {}, gz[kLanes] = {};
    for (std::size_t j = 0; j < s.count; ++j) {
        const double sx = s.x[j], sy = s.y[j], sz = s.z[j], w = s.w[j], w3 = 3 * s.w[j];
        for (int l = 0; l < kLanes; ++l) {
            const double dx = t.x[l] - sx, dy = t.y[l] - sy, dz = t.z[l] - sz;
            const double r2 = dx * dx + dy * dy + dz * dz, r = std::sqrt(r2);
            double value = 1, slope_factor = 1;  // of r^3 and 3 r
            if constexpr (kScreened) screened_factors(r2, r, value, slope_factor);
            const double factor = w3 * (r * slope_factor);
            if constexpr (kWithValues) sum[l] += w * (r2 * (r * value));
            gx[l] += factor * dx;
            gy[l] += factor * dy;
            gz[l] += factor * dz;
        }
    }
    for (int l = 0; l < kLanes; ++l) {
        if constexpr (kWithValues) out[l] = sum[l];
        slope.x[l] = gx[l];
        slope.y[l] = gy[l];
        slope.z[l] = gz[l];
    }
}

KONTUR_EVERY_INSTRUCTION_SET void sum_triharmonic_gradient(const Sources& s, const Lanes& t, Lanes& slope) {
    sum_cube_slopes<false, false>(s, t, nullptr, slope);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_screened_gradient(const Sources& s, const Lanes& t, Lanes& slope) {
    sum_cube_slopes<true, false>(s, t, nullptr, slope);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_triharmonic_both(const Sources& s, const Lanes& t, double* __restrict out,
                                                       Lanes& slope) {
    sum_cube_slopes<false, true>(s, t, out, slope);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_screened_both(const Sources& s, const Lanes& t, double* __restrict out, Lanes& slope) {
    sum_cube_slopes<true, true>(s, t, out, slope);
}

KONTUR_EVERY_INSTRUCTION_SET void sum_biharmonic_gradient(const Sources& s, const Lanes& t, Lanes& out) {
    alignas(64) double gx[kLanes] = {}, gy[kLanes] = {}, gz[kLanes] = {};
    for (std::size_t j = 0; j < s.count; ++j) {
        const double sx = s.x[j], sy = s.y[j], sz = s.z[j], w = s.w[j];
        for (int l = 0; l < kLanes; ++l) {
            const double dx = t.x[l] - sx, dy = t.y[l] - sy, dz = t.z[l] - sz;
            const double r = std::sqrt(dx * dx + dy * dy + dz * dz);
            const double factor = r > 0 ? w / r : 0.0;
            gx[l] += factor * dx;
            gy[l] += factor * dy;
            gz[l] += factor * dz;
        }
    }
    for (int l = 0; l < kLanes; ++l) {
        out.x[l] = gx[l];
        out.y[l] = gy[l];
        out.z[l] = gz[l];
    }
}

#if KONTUR_X86_64_LEVEL != 1

constexpr int kPacks = kLanes / 8;

[[gnu::always_inline]] inline void load(const std::array<double, kLanes>& from, int pack, Pack8& to) {
    for (std::size_t l = 0; l < 8; ++l) to[l] = from[static_cast<std::size_t>(8 * pack) + l];
}

/// sum_screened with roots by estimate. Sums of gradients gain nothing by them.
__attribute__((target("arch=x86-64-v4"))) void sum_screened_by_estimate(const Sources& s, const Lanes& t,
                                                                        double* __restrict out) {
    Pack8 x[kPacks], y[kPacks], z[kPacks], sum[kPacks] = {};
    for (int p = 0; p < kPacks; ++p) {
        load(t.x, p, x[p]);
        load(t.y, p, y[p]);
        load(t.z, p, z[p]);
    }
    for (std::size_t j = 0; j < s.count; ++j) {
        Pack8 squared[kPacks], r[kPacks], even[kPacks], odd[kPacks], phi[kPacks];
#pragma GCC unroll 4
        for (int p = 0; p < kPacks; ++p) {
            const Pack8 dx = x[p] - s.x[j], dy = y[p] - s.y[j], dz = z[p] - s.z[j];
            squared[p] = dx * dx + dy * dy + dz * dz;
        }
#pragma GCC unroll 4
        for (int p = 0; p < kPacks; ++p) root_by_estimate(squared[p], r[p]);
#pragma GCC unroll 4
        for (int p = 0; p < kPacks; ++p) {
            screened_halves(kScreenedValue, squared[p], even[p], odd[p]);
            screened_value(squared[p], r[p], even[p], odd[p], phi[p]);
            sum[p] += s.w[j] * phi[p];
        }
    }
    for (int p = 0; p < kPacks; ++p)
        for (int l = 0; l < 8; ++l) out[8 * p + l] = sum[p][l];
}

#endif

using SumValues = void(const Sources&, const Lanes&, double*);

/// By the roots that are fastest here.
SumValues* fastest_screened() {
#if KONTUR_X86_64_LEVEL != 1
    if (gains_by_estimate()) return sum_screened_by_estimate;
#endif
    return sum_screened;
}

Sources sources(const PointArrays& centers, std::span<const double> weights) {
    return {centers.x.data(), centers.y.data(), centers.z.data(), weights.data(), centers.size()};
}

/// Copies targets [begin, begin + count) into lanes; unused lanes repeat the first so that they cost no denormals.
void load(const PointArrays& targets, std::size_t begin, std::size_t count, Lanes& lanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
        const std::size_t t = begin + (l < count ? l : 0);
        lanes.x[l] = targets.x[t];
        lanes.y[l] = targets.y[t];
        lanes.z[l] = targets.z[t];
    }
}

/// Calls body(begin, count) for runs of at most kLanes targets.
template <class Body>
void for_each_lane_group(std::size_t target_count, const Work& work, const Body& body) {
    parallel_for(static_cast<std::int64_t>(target_count), kTargetsPerChunk, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; t += kLanes)
            body(static_cast<std::size_t>(t), static_cast<std::size_t>(std::min<std::int64_t>(kLanes, end - t)));
    });
}

/// The sums at all targets by one of the functions above.
void sum_values(SumValues* sum, const Sources& from, const PointArrays& targets, std::span<double> out, const Work& work) {
    for_each_lane_group(targets.size(), work, [&](std::size_t begin, std::size_t count) {
        Lanes lanes;
        alignas(64) std::array<double, kLanes> result;
        load(targets, begin, count, lanes);
        sum(from, lanes, result.data());
        std::copy_n(result.begin(), count, out.begin() + static_cast<std::ptrdiff_t>(begin));
    });
}

}  // namespace

PointArrays::PointArrays(std::span<const Vec3> points) {
    x.reserve(points.size());
    y.reserve(points.size());
    z.reserve(points.size());
    for (const Vec3& p : points) {
        x.push_back(p.x);
        y.push_back(p.y);
        z.push_back(p.z);
    }
}

EvenPowers even_powers(const PointArrays& centers, std::span<const double> weights) {
    constexpr double l = kScreeningLength;
    long double sum = 0, squares = 0, x = 0, y = 0, z = 0;  // large terms that nearly cancel
    for (std::size_t j = 0; j < centers.size(); ++j) {
        const Vec3 c = centers[j];
        const long double w = weights[j];
        sum += w;
        x += w * c.x;
        y += w * c.y;
        z += w * c.z;
        squares += w * dot(c, c);
    }
    return {static_cast<double>(3 * l * l * l * sum - 1.5 * l * squares),
            {static_cast<double>(3 * l * x), static_cast<double>(3 * l * y), static_cast<double>(3 * l * z)},
            static_cast<double>(-1.5 * l * sum)};
}

void sum_kernel(const KernelSum& sum, const PointArrays& targets, std::span<double> out, const Work& work) {
    sum_values(sum.kernel == Kernel::screened      ? fastest_screened()
               : sum.kernel == Kernel::triharmonic ? sum_triharmonic
                                                   : sum_biharmonic,
               sources(sum.centers, sum.weights), targets, out, work);
}

void sum_far_kernel(const PointArrays& centers, std::span<const double> weights, const PointArrays& targets,
                    std::span<double> out, const Work& work) {
    sum_values(sum_screened_far, sources(centers, weights), targets, out, work);
}

void sum_far_kernel_twice(const PointArrays& centers, const WeightPair& weights, const PointArrays& targets,
                          const SumPair& out, const Work& work) {
    const Sources from = sources(centers, weights.first);
    for_each_lane_group(targets.size(), work, [&](std::size_t begin, std::size_t count) {
        Lanes lanes;
        alignas(64) std::array<double, kLanes> first, second;
        load(targets, begin, count, lanes);
        sum_screened_far_twice(from, weights.second.data(), lanes, first.data(), second.data());
        std::copy_n(first.begin(), count, out.first.begin() + static_cast<std::ptrdiff_t>(begin));
        std::copy_n(second.begin(), count, out.second.begin() + static_cast<std::ptrdiff_t>(begin));
    });
}

void sum_kernel_gradient(const KernelSum& sum, const PointArrays& targets, std::span<Vec3> out, const Work& work) {
    const auto add = sum.kernel == Kernel::screened      ? sum_screened_gradient
                     : sum.kernel == Kernel::triharmonic ? sum_triharmonic_gradient
                                                         : sum_biharmonic_gradient;
    for_each_lane_group(targets.size(), work, [&](std::size_t begin, std::size_t count) {
        Lanes lanes, result;
        load(targets, begin, count, lanes);
        add(sources(sum.centers, sum.weights), lanes, result);
        for (std::size_t l = 0; l < count; ++l) out[begin + l] = {result.x[l], result.y[l], result.z[l]};
    });
}

void sum_kernel_and_gradient(const KernelSum& sum, const PointArrays& targets, std::span<double> values,
                             std::span<Vec3> gradients, const Work& work) {
    if (sum.kernel == Kernel::biharmonic) {
        sum_kernel(sum, targets, values, work);
        sum_kernel_gradient(sum, targets, gradients, work);
        return;
    }
    const auto add = sum.kernel == Kernel::screened ? sum_screened_both : sum_triharmonic_both;
    for_each_lane_group(targets.size(), work, [&](std::size_t begin, std::size_t count) {
        Lanes lanes, slope;
        alignas(64) std::array<double, kLanes> result;
        load(targets, begin, count, lanes);
        add(sources(sum.centers, sum.weights), lanes, result.data(), slope);
        std::copy_n(result.begin(), count, values.begin() + static_cast<std::ptrdiff_t>(begin));
        for (std::size_t l = 0; l < count; ++l) gradients[begin + l] = {slope.x[l], slope.y[l], slope.z[l]};
    });
}

}  // namespace kontur
