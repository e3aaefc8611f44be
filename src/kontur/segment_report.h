// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kontur/fit/residual.h"
#include "kontur/image/image_report.h"
#include "kontur/measure/section_check.h"
#include "kontur/segment_options.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/near_lines.h"
#include "kontur/shape/provenance.h"
#include "kontur/sureness/surface_uncertainty.h"

namespace kontur {

/// What became of the options and what was found on the way from contours to mask.
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
    UseImage use_image = UseImage::automatic;
    ImageReport image;  ///< what became of the image between the contours
    int solves = 0;
    int iterations = 0;                 ///< over all solves; 0 for direct solvers
    Residual residual;                  ///< at all drawn points
    std::vector<Crossing> crossings;    ///< of contours of different planes, those that disagree most first
    SectionCheck section_check;         ///< of the result against its own drawing
    std::vector<NearLines> near_lines;  ///< lines of one plane that are one or leave a thin wall, counted as they came
    std::int64_t evaluations = 0;       ///< function values computed to voxelize
    std::int64_t surface_voxels = 0;    ///< lattice cells that the surface passes through
    std::int64_t mask_voxels = 0;
    double mask_volume_ml = 0;
    std::int64_t mask_components = 0;                     ///< face-connected
    SurfaceUncertainty uncertainty;                       ///< of the surface, from three planes on
    double estimated_memory_mb = 0;                       ///< before the fit, of the whole process
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time by stage, in order
    std::vector<std::string> warnings;                    ///< choices made for the user and doubts, one sentence each
};

/// What determines the result, for write_mask and write_mesh: version, digests of contours and grid, options as used. The
/// number of threads is left out, which changes nothing.
Provenance provenance(const ContourSet& contours, const Grid& grid, const SegmentReport& report);

/// The report as JSON of several lines with a line break at its end: what `kontur segment --report` writes and Python's
/// `SegmentReport.to_json` gives. Keys and order are stable, further keys may follow; docs/command-line.md describes them.
/// Unlike in C++ contours are counted from 1; `seconds` has a `total`; `peak_memory_mb` is that of the calling process now.
/// NaN and infinity become null, and what is no UTF-8 gets replacement characters.
std::string to_json(const SegmentReport& report, const Provenance& provenance = {});

/// Over all stages in the report.
double total_seconds(const SegmentReport& report);

}  // namespace kontur
