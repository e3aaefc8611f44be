// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/drawing/conflicts.h"
#include "kontur/drawing/corners.h"
#include "kontur/extract/voxelizer.h"
#include "kontur/fit/normals.h"
#include "kontur/function/kernel.h"
#include "kontur/image/image_report.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/grid.h"
#include "kontur/solve/solver.h"

namespace kontur {

/// How contours become a segmentation. `kernel = triharmonic`, `normals = in_plane`, `normal_offset_mm = 1`,
/// `solver = dense` is the paper as printed.
struct SegmentOptions {
    Kernel kernel = Kernel::screened;
    Normals normals = Normals::surface;
    std::optional<double> normal_offset_mm{};    ///< length of the normal constraints; unset: 1.35 % of the contours'
                                                 ///< diameter, in-plane normals 0.45 %
    std::optional<double> smoothing{};           ///< on unit coordinates; unset: 1e-5 with surface normals, else 0
    Conflicts conflicts = Conflicts::reconcile;  ///< where contours contradict each other; surface normals only
    FillRule fill_rule = FillRule::even_odd;     ///< what contours inside others of their plane mean
    Corners corners = Corners::rounded;          ///< what becomes of the corners of closed contours; surface normals only
    double quality = 1.0;                        ///< fraction of each contour's points that the fit uses, in (0, 1]
    Solver solver = Solver::automatic;
    std::optional<double> tolerance_mm{};  ///< of the iterative solver, at all constraints; unset: 1.5e-5 of the diameter
    Voxelizer voxelizer = Voxelizer::adaptive;
    UseImage use_image = UseImage::automatic;  ///< between the contours; where an image is given
    bool mesh = false;                         ///< also make the surface
    /// What was drawn on, where no image is given: the object goes on where its border cuts it off. Unset: without border.
    std::optional<Grid> drawn_on{};
    /// A run of which the process would hold more is refused before it begins to solve; unset: the machine's memory.
    std::optional<double> max_memory_mb{};
};

}  // namespace kontur
