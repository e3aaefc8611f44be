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
                            Voxelizer voxelizer, const Work& work) {
    if (voxelizer == Voxelizer::exhaustive) return sample_everywhere(function, grid, work);
    const Entries from_outside = entries(function, grid, starts, work);
    starts.insert(starts.end(), from_outside.points.begin(), from_outside.points.end());
    SurfaceLattice surface = voxelizer == Voxelizer::tracked ? track_surface(function, grid, starts, work)
                                                             : track_surface_adaptively(function, grid, starts, work);
    surface.evaluations += from_outside.evaluations;
    return surface;
}

TriangleMesh surface_mesh(const SurfaceLattice& surface, const ImplicitFunction& function, std::vector<Vec3> starts,
                          const SurfaceMeshOptions& options, const Work& work) {
    const Grid grid = mesh_grid(surface, starts, options.spacing_mm);
    if (grid == surface.lattice.grid()) return polygonize(surface, function, work);
    if (options.voxelizer == Voxelizer::exhaustive) {  // what no contour touches is in the mask, too
        const std::vector<Vec3> cuts = cut_points(surface);
        starts.insert(starts.end(), cuts.begin(), cuts.end());
    }
    const SurfaceLattice finer = find_surface(function, grid, std::move(starts), Voxelizer::adaptive, work);
    return polygonize(finer, function, work);
}

}  // namespace kontur
