// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/fit/constraints.h"
#include "kontur/fit/prepare.h"
#include "kontur/phantom/cases.h"
#include "kontur/segment.h"

/// The method as Heckel, Konrad & Peitgen 2010 describe it, put together from kontur's parts.
namespace kontur::bench {

/// All points that the reduction keeps, in-plane normals with constraints 1 mm outside, nothing merged, limited or smoothed.
PreparedContours published_contours(const PhantomCase& phantom, double quality);
PlaceOptions published_placing();

/// Contours to mask with the solver that is named, by tracking, on all threads. Of the report only quality, centres,
/// normals, solves, residual and the seconds are filled in.
Segmentation segment_as_published(const PhantomCase& phantom, Solver solver, double quality = 1);

/// Where to start tracking: all drawn points.
std::vector<Vec3> drawn_points(const ContourSet& set);

}  // namespace kontur::bench
