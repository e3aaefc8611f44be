// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/linear_system.h"

#include "kontur/base/error.h"

namespace kontur {
namespace {

template <class Score>
std::size_t best_center(const PointArrays& centers, const Score& score) {
    std::size_t best = 0;
    double best_score = -1;
    for (std::size_t i = 0; i < centers.size(); ++i)
        if (const double s = score(centers[i]); s > best_score) {
            best_score = s;
            best = i;
        }
    return best;
}

}  // namespace

std::array<std::size_t, 4> spread_centers(const PointArrays& centers) {
    Vec3 mean;
    for (std::size_t i = 0; i < centers.size(); ++i) mean += centers[i];
    mean *= 1.0 / static_cast<double>(centers.size());

    const std::size_t a = best_center(centers, [&](const Vec3& p) { return distance(p, mean); });
    const Vec3 pa = centers[a];
    const std::size_t b = best_center(centers, [&](const Vec3& p) { return distance(p, pa); });
    const Vec3 pb = centers[b];
    const std::size_t c = best_center(centers, [&](const Vec3& p) { return norm(cross(pb - pa, p - pa)); });
    const Vec3 area = cross(pb - pa, centers[c] - pa);
    const std::size_t d = best_center(centers, [&](const Vec3& p) { return std::abs(dot(area, p - pa)); });

    // In the unit ball a real body spans a volume of order 1; offset points alone leave a contour's plane by about 1e-3.
    if (!(std::abs(dot(area, centers[d] - pa)) > 1e-9))
        throw Error(ErrorKind::singular_system, "all constraints lie in one plane, so the surface is not determined");
    return {a, b, c, d};
}

std::array<double, 4> linear_through(const PointArrays& centers, const std::array<std::size_t, 4>& spread,
                                     const std::array<double, 4>& values) {
    const Vec3 origin = centers[spread[0]];
    Affine3 edges;  // gradient . edge_m = values[m] - values[0]
    for (int m = 1; m < 4; ++m) {
        const Vec3 edge = centers[spread[static_cast<std::size_t>(m)]] - origin;
        edges.linear[m - 1] = {edge.x, edge.y, edge.z};
    }
    const Vec3 gradient =
        edges.inverse().apply_linear({values[1] - values[0], values[2] - values[0], values[3] - values[0]});
    return {values[0] - dot(gradient, origin), gradient.x, gradient.y, gradient.z};
}

void add_even_powers(Kernel kernel, const PointArrays& centers, std::span<const double> weights, std::span<double> image) {
    if (kernel != Kernel::screened) return;
    const EvenPowers powers = even_powers(centers, weights);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] += powers.value(centers[i]);
}

double largest_residual(const LinearSystem& system, const Coefficients& c, const Work& work) {
    std::vector<double> sums(system.size());
    sum_kernel({system.kernel, system.centers, c.weights}, system.centers, sums, work);
    add_even_powers(system.kernel, system.centers, c.weights, sums);
    double largest = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const Vec3 p = system.centers[i];
        const double f = sums[i] + c.polynomial[0] + c.polynomial[1] * p.x + c.polynomial[2] * p.y + c.polynomial[3] * p.z;
        const double error = std::abs(f + system.diagonal(i) * c.weights[i] - system.values[i]);
        if (!std::isfinite(error)) return error;  // std::max would pass over NaN
        largest = std::max(largest, error);
    }
    return largest;
}

}  // namespace kontur
