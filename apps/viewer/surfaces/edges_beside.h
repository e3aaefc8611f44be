// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/volume.h"
#include "viewer/model/border_rules.h"

namespace kontur::viewer {

/// A contour beside which the image has stronger edges than on it.
struct EdgeBeside {
    Id contour = 0;
    double offset_mm = 0;  ///< of the edges; outwards, negative: inwards
};

/// How far from the line, along normals in its plane, the image changes most, and at least twice as much as on the line;
/// unset where it does not, and for open lines. Outwards, in mm.
std::optional<double> offset_of_edges(const Contour& contour, const Image& image);

/// Those of a set whose contour `i` has the id `ids[i]`, the farthest first.
std::vector<EdgeBeside> edges_beside(const ContourSet& set, const std::vector<Id>& ids, const Image& image);

}  // namespace kontur::viewer
