// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/uncertainty_map.h"

#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/surface_uncertainty.h"

namespace kontur {
namespace {

/// Whether a voxel shares a face with one on the other side.
bool is_at_border(const Mask& mask, const Index3& voxel) {
    const Grid& grid = mask.grid;
    const auto value = [&](const Index3& at) { return mask.values[grid.offset(at.i, at.j, at.k)] != 0; };
    const bool inside = value(voxel);
    for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
            Index3 next = voxel;
            next[axis] += step;
            if (next[axis] >= 0 && next[axis] < grid.size[axis] && value(next) != inside) return true;
        }
    return false;
}

}  // namespace

Image uncertainty_map(const Mask& mask, const SurfaceEvidence& evidence, const Work& work) {
    check_mask(mask);
    std::vector<float> map(mask.values.size());
    std::vector<std::size_t> border;
    std::vector<Vec3> points;
    const Index3& size = mask.grid.size;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i)
                if (is_at_border(mask, {i, j, k})) {
                    border.push_back(mask.grid.offset(i, j, k));
                    points.push_back(mask.grid.center_mm(i, j, k));
                }
    const std::vector<double> widths = half_widths_mm(evidence, points, work);
    for (std::size_t n = 0; n < widths.size(); ++n) map[border[n]] = static_cast<float>(widths[n]);
    return {mask.grid, std::move(map)};
}

}  // namespace kontur
