// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/cubic_cells.h"

namespace kontur {
namespace {

double weighted(const std::array<double, 4>& w, const double* values, std::size_t step) {
    return w[0] * values[0] + w[1] * values[step] + w[2] * values[2 * step] + w[3] * values[3 * step];
}

}  // namespace

CubicCells::CubicCells(const CoarseLattice& lattice) : lattice_(lattice) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t stride = lattice.stride()[axis];
        for (std::int64_t s = 0; s <= stride; ++s)
            weights_[static_cast<std::size_t>(axis)].push_back(
                weights_at(static_cast<double>(s) / static_cast<double>(stride), axis));
    }
}

/// Of the nodes at -1, 0, 1, 2; of the two in the middle alone where there are no others.
CubicCells::Weights CubicCells::weights_at(double t, int axis) const {
    if (lattice_.stencil_nodes(axis) == 2) return {0, 1 - t, t, 0};
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6};
}

std::array<double, 64> CubicCells::stencil(const Index3& cell) const {
    std::array<double, 64> nodes{};
    const auto first = [&](int axis) { return lattice_.stencil_nodes(axis) == 4 ? 0 : 1; };
    for (int k = first(2); k < 4 - first(2); ++k)
        for (int j = first(1); j < 4 - first(1); ++j)
            for (int i = first(0); i < 4 - first(0); ++i)
                nodes[i + 4 * (j + 4 * k)] = lattice_.value({cell.i + i - 1, cell.j + j - 1, cell.k + k - 1});
    return nodes;
}

void CubicCells::interpolate(const Index3& cell, std::vector<double>& values) const {
    const std::array<double, 64> nodes = stencil(cell);
    const auto& [wi, wj, wk] = weights_;
    const std::size_t ni = wi.size(), nj = wj.size(), nij = ni * nj;
    // First along i, then along j, then along k; what the earlier steps leave follows the values.
    values.resize(wk.size() * nij + 16 * ni + 4 * nij);
    double *along_i = values.data() + wk.size() * nij, *along_ij = along_i + 16 * ni;
    for (std::size_t jk = 0; jk < 16; ++jk)
        for (std::size_t i = 0; i < ni; ++i) along_i[jk * ni + i] = weighted(wi[i], &nodes[4 * jk], 1);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t j = 0; j < nj; ++j)
            for (std::size_t i = 0; i < ni; ++i)
                along_ij[(k * nj + j) * ni + i] = weighted(wj[j], along_i + 4 * k * ni + i, ni);
    for (std::size_t k = 0; k < wk.size(); ++k)
        for (std::size_t ij = 0; ij < nij; ++ij) values[k * nij + ij] = weighted(wk[k], along_ij + ij, nij);
    values.resize(wk.size() * nij);
}

double CubicCells::interpolate_at(const Index3& cell, const Vec3& fraction) const {
    const std::array<double, 64> nodes = stencil(cell);
    std::array<double, 16> along_i;
    std::array<double, 4> along_ij;
    const Weights wi = weights_at(fraction.x, 0), wj = weights_at(fraction.y, 1), wk = weights_at(fraction.z, 2);
    for (std::size_t jk = 0; jk < 16; ++jk) along_i[jk] = weighted(wi, &nodes[4 * jk], 1);
    for (std::size_t k = 0; k < 4; ++k) along_ij[k] = weighted(wj, &along_i[4 * k], 1);
    return weighted(wk, along_ij.data(), 1);
}

}  // namespace kontur
