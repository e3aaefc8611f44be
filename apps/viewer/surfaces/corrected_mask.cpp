// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/corrected_mask.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/base/parallel.h"
#include "kontur/correct/existing_mesh.h"

namespace kontur::viewer {
namespace {

constexpr double kSameVoxel = 0.01;  ///< voxels: centres this near to each other are one

bool is_empty(const Mask& mask) {
    return std::ranges::none_of(mask.values, [](std::uint8_t value) { return value != 0; });
}

bool is_whole(double number) { return std::abs(number - std::round(number)) <= kSameVoxel; }

/// Whether each voxel of `to` within the other grid lies on one of its voxels.
bool is_aligned(const Affine3& to_index, const Index3& size) {
    const Vec3 first = to_index.apply({0, 0, 0});
    const Vec3 last =
        to_index.apply_linear({static_cast<double>(size.i), static_cast<double>(size.j), static_cast<double>(size.k)});
    for (int axis = 0; axis < 3; ++axis) {
        if (!is_whole(first[axis]) || !is_whole(last[axis])) return false;
        for (int other = 0; other < 3; ++other)
            if (!is_whole(to_index.column(other)[axis])) return false;
    }
    return true;
}

Index3 rounded(const Vec3& index) { return {std::llround(index.x), std::llround(index.y), std::llround(index.z)}; }

SurfaceOrigin origin_of(CorrectedVoxel how) {
    switch (how) {
        case CorrectedVoxel::added_drawn:
        case CorrectedVoxel::removed_drawn:
            return SurfaceOrigin::drawn;
        case CorrectedVoxel::added_carried:
        case CorrectedVoxel::removed_carried:
            return SurfaceOrigin::carried;
        case CorrectedVoxel::added_image:
        case CorrectedVoxel::removed_image:
            return SurfaceOrigin::by_image;
        default:
            return SurfaceOrigin::as_it_was;
    }
}

}  // namespace

Corrections corrections_of(ContourSet drawing, const StructureMask& how) {
    return {std::move(drawing), how.confirmed_planes};
}

bool says_nothing(const Corrections& corrections) {
    const ContourSet& set = corrections.drawing;
    return set.contours.empty() && set.interior.empty() && set.exterior.empty() && set.empty_planes.empty() &&
           corrections.confirmed.empty();
}

CorrectOptions correct_options(const StructureMask& how) { return {.reach = how.reach, .drop_loose = how.drop_loose}; }

TriangleMesh mesh_of(const Mask& mask, const Work& work) {
    if (is_empty(mask)) return {};
    const ExistingSurface surface(mask, work);
    return ExistingMesh(surface, work).mesh(work);
}

std::vector<std::uint8_t> origins_of(const std::vector<CorrectedVoxel>& made_by) {
    std::vector<std::uint8_t> origins;
    origins.reserve(made_by.size());
    for (const CorrectedVoxel how : made_by) origins.push_back(static_cast<std::uint8_t>(origin_of(how)));
    return origins;
}

Mask on_grid(const Mask& mask, const Grid& grid, const Work& work) {
    if (mask.grid == grid) return mask;
    Mask there{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    if (is_empty(mask)) return there;
    const Affine3 to_index = compose(mask.grid.index_to_mm.inverse(), grid.index_to_mm);
    const Index3 &size = grid.size, &own = mask.grid.size;
    const bool has_same_voxels = is_aligned(to_index, size);
    std::optional<ExistingSurface> surface;
    if (!has_same_voxels) surface.emplace(mask, work);
    parallel_for(size.k, 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
            for (std::int64_t j = 0; j < size.j; ++j)
                for (std::int64_t i = 0; i < size.i; ++i) {
                    std::uint8_t& value = there.values[grid.offset(i, j, k)];
                    if (surface) {
                        value = surface->value(grid.center_mm(i, j, k)) > 0;
                        continue;
                    }
                    const Index3 at =
                        rounded(to_index.apply({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
                    if (at.i >= 0 && at.j >= 0 && at.k >= 0 && at.i < own.i && at.j < own.j && at.k < own.k)
                        value = mask.values[mask.grid.offset(at.i, at.j, at.k)];
                }
    });
    return there;
}

}  // namespace kontur::viewer
