// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/labels/painted_slices.h"
#include "kontur/labels/section_distances.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A body, such as a steep vessel, that passes from a part of a section to a part of the next one, although they lie beside
/// each other: no distances in the slices tell of it.
struct Strand {
    SectionField low, high;
    double way_u = 0, way_v = 0;  ///< from the middle of the lower part to that of the upper one, in voxels
    double belief = 0;            ///< from 0 to 1

    /// The depth in mm at indices of the slice, `along` of the way up, of both parts moved over each other, and whether that
    /// is in or beside them.
    double depth_mm(double along, double u, double v, double gap_mm) const;
    bool is_near(double along, double u, double v) const;
};

struct Strands {
    std::vector<Strand> strands;
    std::vector<std::uint8_t> low_rest, high_rest;  ///< the sections without the strands' parts
};

/// Parts (8-connected) of two sections that hardly lie over the other section, each the nearest such part to the other one.
/// `belief` fades with their overlap, from none to 15 % of the smaller one. It also fades where the room between them is
/// more than half as wide as the thinner one; from one and a half of its widths on these are two bodies.
Strands find_strands(const Grid& grid, const PaintedSlice& low, const PaintedSlice& high);

}  // namespace kontur
