// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/segment.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"
#include "kontur/sureness/suggest_plane.h"

namespace kontur {

/// Where to draw next, of a segmentation and the contours that it was made from: suggest_planes of all that is known of its
/// surface. Throws Error(invalid_input) as that does.
PlaneSuggestions suggest_planes(const Segmentation& segmentation, const ContourSet& contours, std::size_t count = 1,
                                const SuggestPlaneOptions& options = {}, const Work& work = {});

/// Half the width in mm of the band in which the true surface is expected with 90 %, at points on or near the surface, such
/// as its mesh's. Empty below three different planes, of which nothing is known.
std::vector<double> half_widths_mm(const Segmentation& segmentation, const ContourSet& contours,
                                   const std::vector<Vec3>& points, const Work& work = {});

/// The same, as float, at the voxels on both sides of the mask's border; 0 elsewhere, and everywhere below three planes.
Image uncertainty_map(const Segmentation& segmentation, const ContourSet& contours, const Work& work = {});

}  // namespace kontur
