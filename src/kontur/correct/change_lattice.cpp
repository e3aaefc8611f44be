// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/change_lattice.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

constexpr double kLatticeOfLength = 1.0 / 6;

}  // namespace

ChangeLattice::ChangeLattice(const ExistingSurface& surface, const SurfaceChange& change, const IndexBox& box,
                             const Work& work) {
    const Vec3 spacing = surface.grid().spacing_mm();
    const double step = std::max(smallest(spacing), kLatticeOfLength * change.length_mm());
    for (int axis = 0; axis < 3; ++axis) {
        step_[axis] = std::max(std::int64_t{1}, static_cast<std::int64_t>(step / spacing[axis]));
        const std::int64_t before = (box.low[axis] - surface.object_box().low[axis]) % step_[axis];
        first_[axis] = box.low[axis] - (before < 0 ? before + step_[axis] : before);
        size_[axis] = (box.high[axis] - first_[axis]) / step_[axis] + 2;
    }
    values_.resize(static_cast<std::size_t>(size_.i * size_.j * size_.k));
    near_mm_ = 1.1 * change.largest_mm() + 2 * step + largest(spacing);
    std::vector<Vec3> places;
    std::vector<std::size_t> nodes;
    for (std::size_t n = 0; n < values_.size(); ++n) {
        const Index3 voxel = voxel_of(static_cast<std::int64_t>(n));
        if (std::abs(surface.value_at_voxel(voxel)) > near_mm_) continue;
        places.push_back(surface.grid().center_mm(voxel.i, voxel.j, voxel.k));
        nodes.push_back(n);
    }
    const std::vector<double> values = change.values(places, work);
    for (std::size_t n = 0; n < nodes.size(); ++n) values_[nodes[n]] = values[n];
}

double ChangeLattice::at(const Index3& voxel) const {
    Index3 low;
    Vec3 part;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t from = voxel[axis] - first_[axis];
        low[axis] = from / step_[axis];
        part[axis] = static_cast<double>(from % step_[axis]) / static_cast<double>(step_[axis]);
    }
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        Index3 node = low;
        for (int axis = 0; axis < 3; ++axis) {
            const bool high = corner >> axis & 1;
            weight *= high ? part[axis] : 1 - part[axis];
            node[axis] += high;
        }
        if (weight > 0) sum += weight * values_[static_cast<std::size_t>(offset(node))];
    }
    return sum;
}

Index3 ChangeLattice::voxel_of(std::int64_t node) const {
    const Index3 at = index_at(static_cast<std::size_t>(node), size_);
    return {first_.i + at.i * step_.i, first_.j + at.j * step_.j, first_.k + at.k * step_.k};
}

}  // namespace kontur
