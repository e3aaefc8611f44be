// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/progress.h"
#include "kontur/extract/voxelize.h"
#include "kontur/field/fit.h"
#include "kontur/field/reconcile.h"
#include "kontur/field/residual.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// How contours become a segmentation. `kernel = triharmonic`, `normals = in_plane`, `normal_offset_mm = 1`,
/// `solver = dense` is the paper as printed.
struct SegmentOptions {
    Kernel kernel = Kernel::screened;
    Normals normals = Normals::surface;
    std::optional<double> normal_offset_mm{};  ///< length of the normal constraints; unset: 0.45 % of the contours' diameter
    std::optional<double> smoothing{};         ///< on unit coordinates; unset: 1e-5 with surface normals, else 0
    Conflicts conflicts = Conflicts::reconcile;  ///< where contours contradict each other; surface normals only
    FillRule fill_rule = FillRule::even_odd;     ///< what contours inside others of their plane mean
    Corners corners = Corners::rounded;          ///< what becomes of the corners of closed contours; surface normals only
    double quality = 1.0;                        ///< fraction of each contour's points that the fit uses, in (0, 1]
    Solver solver = Solver::automatic;
    std::optional<double> tolerance_mm{};  ///< of the iterative solver, at all constraints; unset: 1.5e-5 of the diameter
    Voxelizer voxelizer = Voxelizer::adaptive;
    bool mesh = false;  ///< also make the surface
    int threads = 0;    ///< 0: the machine's
    /// A run of which the process would hold more is refused before it begins to solve; unset: the machine's memory.
    std::optional<double> max_memory_mb{};
};

struct SegmentReport {
    std::size_t contours = 0;
    std::size_t points = 0;       ///< drawn points
    std::size_t constraints = 0;  ///< placed and kept
    std::size_t merged = 0;       ///< constraints left out because others lie within 0.06 % of the diameter
    std::size_t bounded = 0;      ///< bounds at which f is held: outside in a drawn plane, or beyond an end
    std::size_t centres = 0;      ///< weights of the implicit function
    Kernel kernel = Kernel::screened;
    Normals normals = Normals::surface;
    double normal_offset_mm = 0;
    double smoothing = 0;
    double tolerance_mm = 0;  ///< of the iterative solver
    FillRule fill_rule = FillRule::even_odd;
    Conflicts conflicts = Conflicts::reconcile;
    Corners corners = Corners::rounded;
    double quality = 1;
    Solver solver = Solver::automatic;
    Voxelizer voxelizer = Voxelizer::adaptive;
    int solves = 0;
    int iterations = 0;               ///< over all solves; 0 for direct solvers
    Residual residual;                ///< at all drawn points
    std::vector<Crossing> crossings;  ///< of contours of different planes, those that disagree most first
    std::int64_t evaluations = 0;     ///< function values computed to voxelize
    std::int64_t surface_voxels = 0;  ///< lattice cells that the surface passes through
    std::int64_t mask_voxels = 0;
    double mask_volume_ml = 0;
    std::int64_t mask_components = 0;                     ///< face-connected
    double estimated_memory_mb = 0;                       ///< before the fit, of the whole process
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order
    std::vector<std::string> warnings;                    ///< choices made for the user and doubts, one sentence each
};

struct Segmentation {
    Mask mask;
    ImplicitFunction function;
    std::optional<TriangleMesh> mesh;
    SegmentReport report;
};

/// Contours to mask (and mesh) on a grid. Throws Error as check_contours, check_contours_inside, solve and check_grid do,
/// and Error(too_large) with the estimate for a run beyond `max_memory_mb`. The same bytes for any number of threads.
Segmentation segment(const ContourSet& contours, const Grid& grid, const SegmentOptions& options = {},
                     const Progress& progress = {});

/// What determines the result, for write_mask and write_mesh: version, digests of contours and grid, options as used. The
/// number of threads is left out, which changes nothing.
Provenance provenance(const ContourSet& contours, const Grid& grid, const SegmentReport& report);

}  // namespace kontur
