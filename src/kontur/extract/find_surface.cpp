// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/find_surface.h"

#include <utility>

#include "kontur/extract/adaptive.h"
#include "kontur/extract/entries.h"
#include "kontur/extract/mesh_grid.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/tracker.h"

namespace kontur {

SurfaceLattice find_surface(const ImplicitFunction& function, const Grid& grid, std::vector<Vec3> starts,
                            const FindSurfaceOptions& options, const Progress& progress) {
    if (options.voxelizer == Voxelizer::exhaustive) return sample_everywhere(function, grid, options.threads, progress);
    const Entries from_outside = entries(function, grid, starts, options.threads, progress);
    starts.insert(starts.end(), from_outside.points.begin(), from_outside.points.end());
    SurfaceLattice surface = options.voxelizer == Voxelizer::tracked
                                 ? track_surface(function, grid, starts, options.threads, progress)
                                 : track_surface_adaptively(function, grid, starts, options.threads, progress);
    surface.evaluations += from_outside.evaluations;
    return surface;
}

TriangleMesh surface_mesh(const SurfaceLattice& surface, const ImplicitFunction& function, std::vector<Vec3> starts,
                          double spacing_mm, const FindSurfaceOptions& options, const Progress& progress) {
    const Grid grid = mesh_grid(surface, starts, spacing_mm);
    if (grid == surface.lattice.grid()) return polygonize(surface, function, options.threads, progress);
    if (options.voxelizer == Voxelizer::exhaustive) {  // what no contour touches is in the mask, too
        const std::vector<Vec3> cuts = cut_points(surface);
        starts.insert(starts.end(), cuts.begin(), cuts.end());
    }
    const SurfaceLattice finer =
        find_surface(function, grid, std::move(starts), {Voxelizer::adaptive, options.threads}, progress);
    return polygonize(finer, function, options.threads, progress);
}

}  // namespace kontur
