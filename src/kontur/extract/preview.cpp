// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"

namespace kontur {
namespace {

// An object bulges beyond its contours by a fraction of their extent; what goes farther is a leak.
constexpr double kMarginFraction = 0.5;
constexpr double kTolerance = 0.02;               // of values, in spacings
constexpr std::int64_t kEvaluationsPerVoxel = 2;  // one value, one normal
constexpr double kMostPoints = 1LL << 36;         // the lattice's table of blocks then takes 1 GB

/// A lattice of cubes with points at multiples of the spacing from the anchor, so that it does not move when the box grows.
Grid lattice_about(const Box3& box, double spacing_mm, const Vec3& anchor_mm) {
    const Box3 covered = box.padded(std::max(kMarginFraction * box.diagonal(), 4 * spacing_mm));
    Grid grid;
    double points = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double first = std::floor((covered.min[axis] - anchor_mm[axis]) / spacing_mm),
                     last = std::ceil((covered.max[axis] - anchor_mm[axis]) / spacing_mm);
        points *= last - first + 1;
        if (!(points <= kMostPoints))
            throw Error(ErrorKind::too_large,
                        fmt::format("a preview with a spacing of {} mm over {:.0f} mm has more than {:.1e} points",
                                    spacing_mm, covered.size()[axis], kMostPoints));
        grid.size[axis] = static_cast<std::int64_t>(last - first) + 1;
        grid.index_to_mm.linear[static_cast<std::size_t>(axis)][static_cast<std::size_t>(axis)] = spacing_mm;
        grid.index_to_mm.translation[axis] = anchor_mm[axis] + first * spacing_mm;
    }
    return grid;
}

Box3 box_of_finite(std::span<const Vec3> points) {
    Box3 box;
    for (const Vec3& p : points)
        if (is_finite(p)) box.extend(p);
    return box;
}

}  // namespace

std::optional<Grid> preview_lattice(std::span<const Vec3> starts, double spacing_mm, const Vec3& anchor_mm) {
    if (!(spacing_mm > 0 && std::isfinite(spacing_mm)))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the preview's spacing is {} mm; it must be finite and above 0", spacing_mm));
    const Box3 box = box_of_finite(starts);
    if (box.is_empty()) return std::nullopt;
    return lattice_about(box, spacing_mm, anchor_mm);
}

std::optional<LatticeSurface> preview_with_lattice(const ImplicitFunction& function, std::span<const Vec3> starts,
                                                   const PreviewOptions& options, const Work& work) {
    const std::optional<Grid> grid = preview_lattice(starts, options.spacing_mm, options.anchor_mm);
    if (!grid) return std::nullopt;
    FastFunction fast(function, {.tolerance_mm = kTolerance * options.spacing_mm,
                                 .expected_points = kEvaluationsPerVoxel * expected_surface_voxels(*grid, starts)});
    SurfaceLattice surface = track_surface_adaptively(fast, *grid, starts, work);
    TriangleMesh mesh = polygonize(surface, fast, work, MeshAccuracy::of_a_screen);
    return LatticeSurface{std::move(mesh), std::move(surface)};
}

TriangleMesh preview_surface(const ImplicitFunction& function, std::span<const Vec3> starts, const PreviewOptions& options,
                             const Work& work) {
    std::optional<LatticeSurface> surface = preview_with_lattice(function, starts, options, work);
    return surface ? std::move(surface->mesh) : TriangleMesh{};
}

}  // namespace kontur
