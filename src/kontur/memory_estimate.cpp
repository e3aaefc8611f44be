// SPDX-License-Identifier: Apache-2.0
#include "kontur/memory_estimate.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/base/machine_memory.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/mesh_grid.h"

namespace kontur {
namespace {

// Bytes, measured on balls and livers from 1,000 to 200,000 centres and 10^5 to 5 x 10^7 voxels, rounded up.
constexpr double kPerCentre = 5000;       // preconditioner and H2 matrix
constexpr double kPerSurfaceVoxel = 240;  // the lattice's blocks of 512 values, coarse and fine
constexpr double kMeshPerSurfaceVoxel = 260;
constexpr double kPerVoxel = 1.1;           // the mask, and a pointer for each block
constexpr double kExhaustivePerVoxel = 10;  // a value for each
constexpr double kBlas = 40e6;              // OpenBLAS's own buffers
constexpr double kAlways = 15e6;            // what the libraries take at first use

double matrix_bytes(double centres, Solver solver) {
    if (solver == Solver::dense) return kBlas + 8 * centres * centres;
    if (solver == Solver::cholesky) return kBlas + 4 * centres * centres;
    return kPerCentre * centres;
}

std::vector<Vec3> all_points(const ContourSet& contours) {
    std::vector<Vec3> points;
    for (const Contour& contour : contours.contours)
        points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

/// A value on the surface and one beside it for each point, and what ends the object; fewer where some nearly repeat others.
double expected_centres(const PreparedContours& prepared) {
    return static_cast<double>(2 * prepared.points.size() + prepared.bounds.size());
}

}  // namespace

double estimated_memory_mb(const Drawing& drawing, const PreparedContours& prepared, const Grid& grid,
                           const SegmentOptions& options) {
    const auto voxels = static_cast<double>(grid.voxel_count());
    const std::vector<Vec3> points = all_points(drawing.contours);
    const double surface = std::min(voxels, 1.5 * static_cast<double>(expected_surface_voxels(grid, points)));
    double bytes = kAlways + matrix_bytes(expected_centres(prepared), options.solver) + kPerVoxel * voxels;
    bytes += options.voxelizer == Voxelizer::exhaustive ? kExhaustivePerVoxel * voxels : kPerSurfaceVoxel * surface;
    if (options.mesh) {
        const Grid fine = with_split_voxels(grid, kMeshSpacingFraction * drawing.diameter_mm());
        const double cells = 1.5 * static_cast<double>(expected_surface_voxels(fine, points));
        bytes += kMeshPerSurfaceVoxel * cells + (cells > surface ? kPerSurfaceVoxel * cells : 0);
    }
    return resident_memory_mb() + bytes / 1e6;
}

void check_memory(double estimated_mb, const SegmentOptions& options) {
    if (options.max_memory_mb && !(*options.max_memory_mb > 0))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("max_memory_mb is {:g}; it must be above 0", *options.max_memory_mb));
    const double limit_mb = options.max_memory_mb.value_or(machine_memory_mb());
    if (estimated_mb <= limit_mb) return;
    throw Error(ErrorKind::too_large,
                fmt::format("this would take about {:.0f} MB of memory; the limit is {:.0f} MB ({})", estimated_mb, limit_mb,
                            options.max_memory_mb ? "max_memory_mb" : "what the machine has"));
}

}  // namespace kontur
