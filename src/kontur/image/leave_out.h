// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/image/follow_image.h"
#include "kontur/image/held_out_errors.h"
#include "kontur/image/image_cells.h"
#include "kontur/image/wrong_cells.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// What was found at planes left out.
struct LeftOutPlanes {
    HeldOutErrors errors;
    ImageCells cells;               ///< around the drawing, on which walks go
    std::vector<WrongCells> wrong;  ///< of each plane

    /// How far the surface is moved, and how far it is drawn to a walk where it is moved so far; both 0 to 1. A walk knows
    /// its cells only, which are larger than voxels where the drawing has many.
    double moving() const { return errors.visibility() * errors.weight(); }
    double walking(double moving) const { return walk_visibility() * walk_weight(wrong, moving); }
    double walk_visibility() const { return errors.visibility(cells.edge_mm()); }
};

/// Leaves out one drawn plane after another, at most 10 of them. It fits the others, lets the image move that surface, and
/// measures how far it passes from the contours left out. Then a random walk on the image's cells begins with the moved
/// surface; the result is how much of the plane is on the wrong side. Nothing where fewer than 3 planes were drawn or too
/// little of them is left.
std::optional<LeftOutPlanes> leave_planes_out(const Drawing& drawing, const Image& image, const FitContours& fit,
                                              const Work& work);

}  // namespace kontur
