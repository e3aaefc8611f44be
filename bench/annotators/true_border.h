// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"
#include "kontur/sureness/surface_evidence.h"

namespace kontur {

/// Points that lie on a true border, with the area that each stands for.
struct BorderPoints {
    std::vector<Vec3> points;
    std::vector<double> areas_mm2;
};

/// Of the faces between voxels inside and outside, `across` times as many along either side of each.
BorderPoints points_on_faces(const Mask& mask, int across);

/// Of the 0.5 level of the mask's trilinear interpolation, which traced contours are sections of: where it crosses the edges
/// of a lattice of thirds of voxels.
std::vector<Vec3> points_on_level(const Mask& mask);

/// Some of the true border's points: distance of the found surface, distance of its place next to the point from the lines,
/// area in mm^2, share of the error that the image leaves there, half width of the band there. Lengths in sizes of the
/// surface.
nlohmann::ordered_json border_rows(const SurfaceEvidence& evidence, const TriangleMesh& found, const BorderPoints& border);

/// To the nearest multiple of `step`, for files.
double rounded(double value, double step);

}  // namespace kontur
