// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/entries.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kontur/extract/adaptive.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/tracker.h"

namespace kontur {
namespace {

constexpr double kLeastSpacingFraction = 1.0 / 250;  // of the diagonal of the starts' box
constexpr double kBorderSpacings = 2;                // how deep the grid's border is, in spacings of the lattice

/// Box of the finite starts, as indices of the grid.
Box3 index_box(const Affine3& mm_to_index, std::span<const Vec3> starts) {
    Box3 box;
    for (const Vec3& p : starts)
        if (is_finite(p)) box.extend(mm_to_index.apply(p));
    return box;
}

bool reaches_beyond(const Box3& box, const Grid& grid) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] < -0.5 || box.max[axis] > static_cast<double>(grid.size[axis]) - 0.5) return true;
    return false;
}

bool overlaps(const Box3& box, const Grid& grid) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.max[axis] >= -0.5 && box.min[axis] <= static_cast<double>(grid.size[axis]) - 0.5)) return false;
    return true;
}

/// The voxels near the faces of a grid, and one voxel's width beyond.
class Border {
public:
    Border(const Grid& grid, double depth_mm) : grid_(grid), mm_to_index_(grid.index_to_mm.inverse()) {
        for (int axis = 0; axis < 3; ++axis) depth_[axis] = 1 + depth_mm / grid.spacing_mm()[axis];
    }

    bool contains(const Vec3& p) const {
        const Vec3 at = mm_to_index_.apply(p);
        bool is_near = false;
        for (int axis = 0; axis < 3; ++axis) {
            const auto size = static_cast<double>(grid_.size[axis]);
            if (!(at[axis] >= -1 && at[axis] <= size)) return false;
            is_near = is_near || at[axis] < depth_[axis] || at[axis] > size - 1 - depth_[axis];
        }
        return is_near;
    }

private:
    const Grid& grid_;
    Affine3 mm_to_index_;
    Vec3 depth_;  ///< in voxels
};

bool in_memory_order(const Index3& a, const Index3& b) { return std::tie(a.k, a.j, a.i) < std::tie(b.k, b.j, b.i); }

/// Whether the surface found encloses a point of its lattice: its row up to there is cut an odd number of times.
bool encloses(const SurfaceLattice& surface, const Index3& point) {
    bool inside = false;
    auto cell = std::lower_bound(surface.cells.begin(), surface.cells.end(), Index3{-1, point.j, point.k}, in_memory_order);
    for (; cell != surface.cells.end() && cell->k == point.k && cell->j == point.j && cell->i < point.i; ++cell)
        inside ^= (surface.lattice.value(*cell) > 0) != (surface.lattice.value(Lattice::corner(*cell, 1)) > 0);
    return inside;
}

/// Whether it encloses one of the lattice's points around a point in mm.
bool encloses_near(const SurfaceLattice& surface, const Vec3& p) {
    const Vec3 at = surface.lattice.grid().index_to_mm.inverse().apply(p);
    if (!fits_index(at)) return false;
    const Index3 low = cell_of(at);
    for (int n = 0; n < 8; ++n) {
        const Index3 corner = Lattice::corner(low, n);
        if (surface.lattice.in_grid(corner) && encloses(surface, corner)) return true;
    }
    return false;
}

}  // namespace

Entries entries(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts, const Work& work) {
    const Box3 box = index_box(grid.index_to_mm.inverse(), starts);
    if (!reaches_beyond(box, grid) || !overlaps(box, grid)) return {};
    Box3 box_mm;
    for (const Vec3& p : starts)
        if (is_finite(p)) box_mm.extend(p);
    const double spacing_mm = std::max(smallest(grid.spacing_mm()), kLeastSpacingFraction * box_mm.diagonal());
    const std::optional<Grid> lattice = preview_lattice(starts, spacing_mm);
    if (!lattice) return {};
    const SurfaceLattice surface = track_surface_adaptively(function, *lattice, starts, work);

    Entries entries;
    entries.evaluations = surface.evaluations;
    const Border border(grid, kBorderSpacings * spacing_mm);
    for (const Vec3& p : cut_points(surface))
        if (border.contains(p)) entries.points.push_back(p);
    // A grid that the surface does not cut lies wholly on one side of it; one so small that it falls between the lattice's
    // points may be cut all the same.
    for (int n = 0; n < 8; ++n) {
        const Vec3 corner =
            grid.center_mm(n & 1 ? grid.size.i - 1 : 0, n & 2 ? grid.size.j - 1 : 0, n & 4 ? grid.size.k - 1 : 0);
        if (encloses_near(surface, corner)) entries.points.push_back(corner);
    }
    return entries;
}

}  // namespace kontur
