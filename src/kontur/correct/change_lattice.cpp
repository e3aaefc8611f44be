// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/change_lattice.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kontur {
namespace {

constexpr double kLatticeOfLength = 1.0 / 6;
constexpr std::int64_t kBeyondGrid = 2;  ///< voxels: slopes of a surface at the border are found by them

}  // namespace

ChangeLattice::ChangeLattice(const ExistingSurface& surface, const SurfaceChange& change, const IndexBox& box,
                             const Work& work)
    : box_(box) {
    const Vec3 spacing = surface.grid().spacing_mm();
    const double step = std::max(smallest(spacing), kLatticeOfLength * change.length_mm());
    for (int axis = 0; axis < 3; ++axis) {
        step_[axis] = std::max(std::int64_t{1}, static_cast<std::int64_t>(step / spacing[axis]));
        const std::int64_t before = (box.low[axis] - surface.object_box().low[axis]) % step_[axis];
        first_[axis] = box.low[axis] - (before < 0 ? before + step_[axis] : before);
        size_[axis] = (box.high[axis] - first_[axis]) / step_[axis] + 2;
        for (std::int64_t n = 0; n <= box.high[axis] - first_[axis]; ++n)
            places_[static_cast<std::size_t>(axis)].push_back(
                {n / step_[axis], static_cast<double>(n % step_[axis]) / static_cast<double>(step_[axis])});
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
    row_most_.resize(static_cast<std::size_t>(size_.j * size_.k));
    for (std::size_t n = 0; n < values_.size(); ++n) {
        double& most = row_most_[n / static_cast<std::size_t>(size_.i)];
        most = std::max(most, std::abs(values_[n]));
    }
}

double ChangeLattice::at(const Index3& voxel) const {
    const Place& x = places_[0][static_cast<std::size_t>(voxel.i - first_.i)];
    const Place& y = places_[1][static_cast<std::size_t>(voxel.j - first_.j)];
    const Place& z = places_[2][static_cast<std::size_t>(voxel.k - first_.k)];
    const double* node = values_.data() + offset({x.low, y.low, z.low});
    const std::int64_t up = size_.i, over = size_.i * size_.j;
    const auto along_i = [&](const double* p) { return (1 - x.part) * p[0] + x.part * p[1]; };
    const auto along_j = [&](const double* p) { return (1 - y.part) * along_i(p) + y.part * along_i(p + up); };
    return (1 - z.part) * along_j(node) + z.part * along_j(node + over);
}

ChangeLattice::Run ChangeLattice::run_from(const Index3& voxel) const {
    const std::int64_t i = places_[0][static_cast<std::size_t>(voxel.i - first_.i)].low;
    const std::int64_t j = places_[1][static_cast<std::size_t>(voxel.j - first_.j)].low;
    const std::int64_t k = places_[2][static_cast<std::size_t>(voxel.k - first_.k)].low;
    const double* node = values_.data() + offset({i, j, k});
    const std::int64_t up = size_.i, over = size_.i * size_.j;
    double most = 0;
    for (const std::int64_t n : {std::int64_t{0}, up, over, up + over})
        most = std::max({most, std::abs(node[n]), std::abs(node[n + 1])});
    return {first_.i + (i + 1) * step_.i, most};
}

double ChangeLattice::most_in_row_mm(std::int64_t j, std::int64_t k) const {
    const std::int64_t low = places_[1][static_cast<std::size_t>(j - first_.j)].low +
                             size_.j * places_[2][static_cast<std::size_t>(k - first_.k)].low;
    const double* most = row_most_.data() + low;
    return std::max({most[0], most[1], most[size_.j], most[size_.j + 1]});
}

Index3 ChangeLattice::voxel_of(std::int64_t node) const {
    const Index3 at = index_at(static_cast<std::size_t>(node), size_);
    return {first_.i + at.i * step_.i, first_.j + at.j * step_.j, first_.k + at.k * step_.k};
}

std::shared_ptr<const ChangeLattice> change_lattice(const ExistingSurface& surface, const SurfaceChange& change,
                                                    const Work& work) {
    if (change.is_zero()) return nullptr;
    const Index3& size = surface.grid().size;
    const IndexBox around{{-kBeyondGrid, -kBeyondGrid, -kBeyondGrid},
                          {size.i - 1 + kBeyondGrid, size.j - 1 + kBeyondGrid, size.k - 1 + kBeyondGrid}};
    std::optional<IndexBox> box = index_box(grid_of(surface.grid(), around), change.box());
    if (!box) return nullptr;
    for (Index3* end : {&box->low, &box->high})
        for (int axis = 0; axis < 3; ++axis) (*end)[axis] -= kBeyondGrid;
    return std::make_shared<const ChangeLattice>(surface, change, *box, work);
}

}  // namespace kontur
