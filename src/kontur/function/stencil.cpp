// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/stencil.h"

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

struct Weights {
    alignas(64) std::array<double, kStencil> value, slope;
};

// 1 / product over the other nodes of their distances.
constexpr std::array<double, kStencil> kNodeFactor = {-1.0 / 5040, 1.0 / 720, -1.0 / 240, 1.0 / 144,
                                                      -1.0 / 144,  1.0 / 240, -1.0 / 720, 1.0 / 5040};

/// Lagrange's basis at u and its slope, from products over the nodes before and behind.
[[gnu::always_inline]] inline Weights lagrange(double u) {
    std::array<double, kStencil + 1> before, before_slope, behind, behind_slope;
    before[0] = 1, before_slope[0] = 0, behind[kStencil] = 1, behind_slope[kStencil] = 0;
    for (std::size_t i = 0; i < kStencil; ++i) {
        const double d = u + kStencilBefore - static_cast<double>(i);
        before[i + 1] = before[i] * d;
        before_slope[i + 1] = before_slope[i] * d + before[i];
    }
    for (std::size_t i = kStencil; i-- > 0;) {
        const double d = u + kStencilBefore - static_cast<double>(i);
        behind[i] = behind[i + 1] * d;
        behind_slope[i] = behind_slope[i + 1] * d + behind[i + 1];
    }
    Weights w;
    for (std::size_t i = 0; i < kStencil; ++i) {
        w.value[i] = kNodeFactor[i] * before[i] * behind[i + 1];
        w.slope[i] = kNodeFactor[i] * (before_slope[i] * behind[i + 1] + before[i] * behind_slope[i + 1]);
    }
    return w;
}

/// The nodes summed over j and k, for each i.
[[gnu::always_inline]] inline std::array<double, kStencil> contract(const StencilValues& nodes,
                                                                    const std::array<double, kStencil>& wj,
                                                                    const std::array<double, kStencil>& wk) {
    alignas(64) std::array<double, kStencil> sum{};
    const double* row = nodes.data();
    for (std::size_t k = 0; k < kStencil; ++k)
        for (std::size_t j = 0; j < kStencil; ++j, row += kStencil) {
            const double w = wj[j] * wk[k];
            for (std::size_t i = 0; i < kStencil; ++i) sum[i] += w * row[i];
        }
    return sum;
}

[[gnu::always_inline]] inline double inner(const std::array<double, kStencil>& a, const std::array<double, kStencil>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < kStencil; ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

KONTUR_EVERY_INSTRUCTION_SET double interpolate(const StencilValues& nodes, const Vec3& at) {
    return inner(contract(nodes, lagrange(at.y).value, lagrange(at.z).value), lagrange(at.x).value);
}

KONTUR_EVERY_INSTRUCTION_SET Vec3 interpolate_gradient(const StencilValues& nodes, const Vec3& at) {
    const Weights x = lagrange(at.x), y = lagrange(at.y), z = lagrange(at.z);
    return {inner(contract(nodes, y.value, z.value), x.slope), inner(contract(nodes, y.slope, z.value), x.value),
            inner(contract(nodes, y.value, z.slope), x.value)};
}

}  // namespace kontur
