// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/field/constraints.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// Unit in-plane normals of an open contour, one per point, to the left of someone who walks along it (Eq. 7; at the ends
/// the normal of the only edge). At the tip of a spike, where the answer is not defined, the zero vector.
std::vector<Vec3> left_normals(const Contour& contour);

/// Says of every open contour that does not tell on which hand the object lies. A coarse fit through all that is known
/// decides, the contour's points among it; where nothing is known, the object is taken to lie towards the middle of all
/// that was drawn. Returns one sentence for each contour, contours counted from 1.
std::vector<std::string> find_sides(ContourSet& set, const std::vector<BoundaryPoint>& known);

}  // namespace kontur
