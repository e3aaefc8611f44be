// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/cubic_cells.h"

namespace kontur {
namespace {

using Weights = std::array<double, 4>;

/// Of the nodes at -1, 0, 1, 2; of the two in the middle alone where there are no others.
Weights weights_at(double t, std::int64_t nodes) {
    if (nodes == 2) return {0, 1 - t, t, 0};
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6};
}

std::array<double, 64> stencil(const CoarseLattice& lattice, const Index3& cell) {
    std::array<double, 64> nodes{};
    const auto first = [&](int axis) { return lattice.stencil_nodes(axis) == 4 ? 0 : 1; };
    for (int k = first(2); k < 4 - first(2); ++k)
        for (int j = first(1); j < 4 - first(1); ++j)
            for (int i = first(0); i < 4 - first(0); ++i)
                nodes[static_cast<std::size_t>(i + 4 * (j + 4 * k))] =
                    lattice.value({cell.i + i - 1, cell.j + j - 1, cell.k + k - 1});
    return nodes;
}

double weighted(const Weights& w, const double* values, std::size_t step) {
    return w[0] * values[0] + w[1] * values[step] + w[2] * values[2 * step] + w[3] * values[3 * step];
}

std::vector<Weights> weights_along(const CoarseLattice& lattice, int axis) {
    const std::int64_t stride = lattice.stride()[axis];
    std::vector<Weights> result;
    for (std::int64_t s = 0; s <= stride; ++s)
        result.push_back(weights_at(static_cast<double>(s) / static_cast<double>(stride), lattice.stencil_nodes(axis)));
    return result;
}

}  // namespace

std::vector<double> interpolate_cell(const CoarseLattice& lattice, const Index3& cell) {
    const std::array<double, 64> nodes = stencil(lattice, cell);
    const std::vector<Weights> wi = weights_along(lattice, 0), wj = weights_along(lattice, 1),
                               wk = weights_along(lattice, 2);
    const std::size_t ni = wi.size(), nj = wj.size();
    std::vector<double> along_i(16 * ni), along_ij(4 * nj * ni), result;
    for (std::size_t jk = 0; jk < 16; ++jk)
        for (std::size_t i = 0; i < ni; ++i) along_i[jk * ni + i] = weighted(wi[i], &nodes[4 * jk], 1);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t j = 0; j < nj; ++j)
            for (std::size_t i = 0; i < ni; ++i)
                along_ij[(k * nj + j) * ni + i] = weighted(wj[j], &along_i[4 * k * ni + i], ni);
    result.reserve(wk.size() * nj * ni);
    for (const Weights& w : wk)
        for (std::size_t ij = 0; ij < nj * ni; ++ij) result.push_back(weighted(w, &along_ij[ij], nj * ni));
    return result;
}

double interpolate_in_cell(const CoarseLattice& lattice, const Index3& cell, const Vec3& fraction) {
    const std::array<double, 64> nodes = stencil(lattice, cell);
    std::array<double, 16> along_i;
    std::array<double, 4> along_ij;
    const auto weights = [&](int axis) { return weights_at(fraction[axis], lattice.stencil_nodes(axis)); };
    for (std::size_t jk = 0; jk < 16; ++jk) along_i[jk] = weighted(weights(0), &nodes[4 * jk], 1);
    for (std::size_t k = 0; k < 4; ++k) along_ij[k] = weighted(weights(1), &along_i[4 * k], 1);
    return weighted(weights(2), along_ij.data(), 1);
}

}  // namespace kontur
