// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/corrected_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/correct/change_lattice.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

constexpr double kDoubtful = 0.1;             ///< of the smallest voxel side: |f| below is computed by itself
constexpr double kInSlice = 0.05;             ///< of the slices' distance: planes this near to a slice are that slice


/// The axis and index of the slice of voxels that a plane is; nullopt for a plane between slices or oblique to them.
std::optional<std::pair<int, std::int64_t>> slice_of(const Plane& plane, const Grid& grid) {
    const Vec3 index = grid.index_to_mm.inverse().apply(plane.origin);
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 a = grid.index_to_mm.column((axis + 1) % 3), b = grid.index_to_mm.column((axis + 2) % 3);
        const double across = norm(grid.index_to_mm.column(axis));
        const double rise = std::abs(dot(plane.normal, a)) * static_cast<double>(grid.size[(axis + 1) % 3]) +
                            std::abs(dot(plane.normal, b)) * static_cast<double>(grid.size[(axis + 2) % 3]);
        const double nearest = std::round(index[axis]);
        if (rise > kInSlice * across || std::abs(index[axis] - nearest) > kInSlice) continue;
        if (nearest < 0 || nearest >= static_cast<double>(grid.size[axis])) return std::nullopt;
        return std::pair(axis, static_cast<std::int64_t>(nearest));
    }
    return std::nullopt;
}

/// The voxels of the slice that a section is, where it differs from what was there.
void append_drawn(const CorrectedSection& section, const Grid& grid, std::vector<VoxelSide>& voxels) {
    const auto slice = slice_of(section.plane, grid);
    if (!slice) return;
    const SectionSearch before(section.before), after(section.after);
    const auto [axis, index] = *slice;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Index3 voxel;
    voxel[axis] = index;
    for (voxel[b] = 0; voxel[b] < grid.size[b]; ++voxel[b])
        for (voxel[a] = 0; voxel[a] < grid.size[a]; ++voxel[a]) {
            const Point2 p = section.plane.to_uv(grid.center_mm(voxel.i, voxel.j, voxel.k));
            const bool inside = after.contains(p);
            if (section.redrawn || inside != before.contains(p))
                voxels.push_back({grid.offset(voxel.i, voxel.j, voxel.k), inside});
        }
}

/// f0 + g at the voxels of a box. What g on a lattice leaves in doubt is computed by itself.
class ChangedBox {
public:
    ChangedBox(const ExistingSurface& surface, const SurfaceChange& change, const IndexBox& box, const Work& work)
        : surface_(surface), change_(change), box_(box), lattice_(surface, change, box, work) {}

    /// Of slice k of the box.
    void write_slice(std::int64_t k, Mask& corrected) const {
        const Grid& grid = corrected.grid;
        const double side = smallest(grid.spacing_mm());
        std::vector<Vec3> places;
        std::vector<std::size_t> doubtful;
        std::vector<double> before;
        for (std::int64_t j = box_.low.j; j <= box_.high.j; ++j)
            for (std::int64_t i = box_.low.i; i <= box_.high.i; ++i) {
                const double f0 = surface_.value_at_voxel({i, j, k});
                if (std::abs(f0) > lattice_.near_mm()) continue;
                const double g = lattice_.at({i, j, k});
                if (std::abs(g) < kLeastChangeVoxels * side) continue;
                const std::size_t offset = grid.offset(i, j, k);
                const double f = f0 + g;
                corrected.values[offset] = f > 0;
                if (std::abs(f) > kDoubtful * side) continue;
                places.push_back(grid.center_mm(i, j, k));
                doubtful.push_back(offset);
                before.push_back(f0);
            }
        Work alone;
        alone.threads = 1;
        const std::vector<double> values = change_.values(places, alone);
        for (std::size_t n = 0; n < doubtful.size(); ++n) corrected.values[doubtful[n]] = before[n] + values[n] > 0;
    }

private:
    const ExistingSurface& surface_;
    const SurfaceChange& change_;
    IndexBox box_;
    ChangeLattice lattice_;
};

/// Of eight voxels: whether both masks have the same, all of them 0 or 1.
bool is_kept(const std::uint8_t* before, const std::uint8_t* after) {
    constexpr std::uint64_t kMoreThanOne = 0xFEFEFEFEFEFEFEFE;
    std::uint64_t was = 0, is = 0;
    std::memcpy(&was, before, 8);
    std::memcpy(&is, after, 8);
    return was == is && (was & kMoreThanOne) == 0;
}

}  // namespace

Mask changed_voxels(const Mask& mask, const ExistingSurface& surface, const SurfaceChange& change, const Work& work) {
    Mask changed = mask;
    if (change.is_zero()) return changed;
    const std::optional<IndexBox> box = index_box(mask.grid, change.box());
    if (!box) return changed;
    const ChangedBox values(surface, change, *box, work);
    parallel_for(box->size().k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k) values.write_slice(box->low.k + k, changed);
    });
    return changed;
}

std::vector<VoxelSide> drawn_voxels(const std::vector<CorrectedSection>& sections, const Grid& grid) {
    std::vector<VoxelSide> voxels;
    for (const CorrectedSection& section : sections)
        if (section.moves(kStillVoxels * smallest(grid.spacing_mm()))) append_drawn(section, grid, voxels);
    return voxels;
}

std::vector<std::uint8_t> voxel_origins(const Mask& before, const Mask& after, const std::vector<VoxelSide>& drawn,
                                        const std::vector<VoxelSide>& by_image) {
    const auto made = [](CorrectedVoxel voxel) { return static_cast<std::uint8_t>(voxel); };
    std::vector<std::uint8_t> origins(before.values.size());
    for (std::size_t n = 0; n < origins.size(); ++n) {
        if (n + 8 <= origins.size() && is_kept(&before.values[n], &after.values[n])) {
            std::memcpy(&origins[n], &before.values[n], 8);
            n += 7;
            continue;
        }
        const bool was = before.values[n] != 0, is = after.values[n] != 0;
        origins[n] = was == is ? made(is ? CorrectedVoxel::inside : CorrectedVoxel::outside)
                               : made(is ? CorrectedVoxel::added_carried : CorrectedVoxel::removed_carried);
    }
    const auto mark = [&](const std::vector<VoxelSide>& voxels, CorrectedVoxel added, CorrectedVoxel removed) {
        for (const VoxelSide& voxel : voxels) {
            std::uint8_t& origin = origins[voxel.offset];
            if (origin == made(CorrectedVoxel::added_carried)) origin = made(added);
            if (origin == made(CorrectedVoxel::removed_carried)) origin = made(removed);
        }
    };
    mark(drawn, CorrectedVoxel::added_drawn, CorrectedVoxel::removed_drawn);
    mark(by_image, CorrectedVoxel::added_image, CorrectedVoxel::removed_image);
    return origins;
}

}  // namespace kontur
