// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/corrected_voxels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

constexpr double kDoubtful = 0.1;  ///< of the smallest voxel side: |f| below is computed by itself
constexpr double kInSlice = 0.05;  ///< of the slices' distance: planes this near to a slice are that slice

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

/// The voxels of a slice in a box, and those beyond it that a section's outlines reach.
IndexBox slice_box(const CorrectedSection& section, const Grid& grid, IndexBox box, int axis, std::int64_t index) {
    std::vector<Vec3> points;
    for (const Polygon2& outline : section.after.outlines)
        for (const Point2& p : outline) points.push_back(section.plane.from_uv(p));
    if (!points.empty())
        if (const auto drawn = index_box(grid, bounding_box(std::span<const Vec3>(points)))) box = box_around(box, *drawn);
    box.low[axis] = box.high[axis] = index;
    return box;
}

/// The voxels of the slice that a section is, where it differs from what was there.
void append_drawn(const CorrectedSection& section, const Grid& grid, const IndexBox& box, std::vector<VoxelSide>& voxels) {
    const auto slice = slice_of(section.plane, grid);
    if (!slice) return;
    const SectionSearch before(section.before), after(section.after);
    const IndexBox here = slice_box(section, grid, box, slice->first, slice->second);
    for (std::int64_t k = here.low.k; k <= here.high.k; ++k)
        for (std::int64_t j = here.low.j; j <= here.high.j; ++j)
            for (std::int64_t i = here.low.i; i <= here.high.i; ++i) {
                const Point2 p = section.plane.to_uv(grid.center_mm(i, j, k));
                const bool inside = after.contains(p);
                if (section.redrawn || inside != before.contains(p)) voxels.push_back({grid.offset(i, j, k), inside});
            }
}

/// f0 + g at the voxels of a box. What g on a lattice leaves in doubt is computed by itself.
class ChangedBox {
public:
    ChangedBox(const Mask& mask, const ExistingSurface& surface, const SurfaceChange& change, const ChangeLattice& lattice,
               const IndexBox& box)
        : mask_(mask), surface_(surface), change_(change), box_(box), lattice_(lattice) {}

    /// Those of slice k of the box that change.
    std::vector<VoxelSide> changed_in(std::int64_t k) const {
        std::vector<VoxelSide> voxels;
        Doubts doubts;
        for (std::int64_t j = box_.low.j; j <= box_.high.j; ++j) append_row(j, k, voxels, doubts);
        Work alone;
        alone.threads = 1;
        const std::vector<double> values = change_.values(doubts.places, alone);
        for (std::size_t n = 0; n < values.size(); ++n) voxels[doubts.voxels[n]].inside = doubts.before[n] + values[n] > 0;
        std::erase_if(voxels, [&](const VoxelSide& voxel) { return voxel.inside == (mask_.values[voxel.offset] != 0); });
        return voxels;
    }

private:
    /// Voxels that are to be computed by themselves.
    struct Doubts {
        std::vector<Vec3> places;
        std::vector<std::size_t> voxels;  ///< which of those found
        std::vector<double> before;       ///< f0
    };

    void append_row(std::int64_t j, std::int64_t k, std::vector<VoxelSide>& voxels, Doubts& doubts) const {
        const double side = smallest(mask_.grid.spacing_mm());
        if (lattice_.most_in_row_mm(j, k) < kLeastChangeVoxels * side) return;
        const IndexBox window = surface_.window_box();
        const bool is_known = j >= window.low.j && j <= window.high.j && k >= window.low.k && k <= window.high.k;
        const float* known = surface_.window_values().data();
        if (is_known) known += surface_.window().offset(0, j - window.low.j, k - window.low.k);
        ChangeLattice::Run run{};
        for (std::int64_t i = box_.low.i; i <= box_.high.i; ++i) {
            if (i == box_.low.i || i == run.end) run = lattice_.run_from({i, j, k});
            if (run.most_mm < kLeastChangeVoxels * side) {
                i = run.end - 1;
                continue;
            }
            const double f0 = is_known && i >= window.low.i && i <= window.high.i
                                  ? static_cast<double>(known[i - window.low.i])
                                  : surface_.value_at_voxel({i, j, k});
            // Farther away f0 + g has f0's sign, and that is the mask's.
            if (std::abs(f0) <= std::min(run.most_mm + kDoubtful * side, lattice_.near_mm()))
                append_voxel({i, j, k}, f0, voxels, doubts);
        }
    }

    void append_voxel(const Index3& at, double f0, std::vector<VoxelSide>& voxels, Doubts& doubts) const {
        const Grid& grid = mask_.grid;
        const double side = smallest(grid.spacing_mm()), g = lattice_.at(at), f = f0 + g;
        if (std::abs(g) < kLeastChangeVoxels * side) return;
        const std::size_t offset = grid.offset(at.i, at.j, at.k);
        if (std::abs(f) <= kDoubtful * side) {
            doubts.places.push_back(grid.center_mm(at.i, at.j, at.k));
            doubts.voxels.push_back(voxels.size());
            doubts.before.push_back(f0);
        } else if ((f > 0) == (mask_.values[offset] != 0)) {
            return;
        }
        voxels.push_back({offset, f > 0});
    }

    const Mask& mask_;
    const ExistingSurface& surface_;
    const SurfaceChange& change_;
    IndexBox box_;
    const ChangeLattice& lattice_;
};

/// What is said of a voxel, the last word counts.
struct VoxelClaim {
    std::size_t offset;
    int by;  ///< 0 carried, 1 drawn, 2 the image
    bool inside;
};

CorrectedVoxel how(bool inside, bool drawn, int by) {
    if (drawn) return inside ? CorrectedVoxel::added_drawn : CorrectedVoxel::removed_drawn;
    if (by == 2) return inside ? CorrectedVoxel::added_image : CorrectedVoxel::removed_image;
    return inside ? CorrectedVoxel::added_carried : CorrectedVoxel::removed_carried;
}

}  // namespace

std::vector<VoxelSide> carried_voxels(const Mask& mask, const ExistingSurface& surface, const SurfaceChange& change,
                                      const ChangeLattice& lattice, const Work& work) {
    const Index3& size = mask.grid.size;
    const std::optional<IndexBox> box = common_box(lattice.box(), {{0, 0, 0}, {size.i - 1, size.j - 1, size.k - 1}});
    if (!box) return {};
    const ChangedBox values(mask, surface, change, lattice, *box);
    std::vector<std::vector<VoxelSide>> slices(static_cast<std::size_t>(box->size().k));
    parallel_for(box->size().k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k) slices[static_cast<std::size_t>(k)] = values.changed_in(box->low.k + k);
    });
    std::vector<VoxelSide> voxels;
    for (const auto& slice : slices) voxels.insert(voxels.end(), slice.begin(), slice.end());
    return voxels;
}

std::vector<VoxelSide> drawn_voxels(const std::vector<CorrectedSection>& sections, const Grid& grid, const IndexBox& box) {
    std::vector<VoxelSide> voxels;
    for (const CorrectedSection& section : sections)
        if (section.moves(kStillVoxels * smallest(grid.spacing_mm()))) append_drawn(section, grid, box, voxels);
    return voxels;
}

std::vector<MadeVoxel> made_voxels(const Mask& before, const std::vector<VoxelSide>& carried,
                                   const std::vector<VoxelSide>& drawn, const std::vector<VoxelSide>& by_image) {
    std::vector<VoxelClaim> claims;
    const auto append = [&](const std::vector<VoxelSide>& voxels, int by) {
        for (const VoxelSide& voxel : voxels) claims.push_back({voxel.offset, by, voxel.inside});
    };
    append(carried, 0);
    append(drawn, 1);
    append(by_image, 2);
    std::ranges::stable_sort(claims, [](const VoxelClaim& a, const VoxelClaim& b) {
        return a.offset != b.offset ? a.offset < b.offset : a.by < b.by;
    });
    std::vector<MadeVoxel> voxels;
    bool is_drawn = false;
    for (std::size_t n = 0; n < claims.size(); ++n) {
        is_drawn = is_drawn || claims[n].by == 1;
        if (n + 1 < claims.size() && claims[n + 1].offset == claims[n].offset) continue;
        if (claims[n].inside != (before.values[claims[n].offset] != 0))
            voxels.push_back({claims[n].offset, how(claims[n].inside, is_drawn, claims[n].by)});
        is_drawn = false;
    }
    return voxels;
}

}  // namespace kontur
