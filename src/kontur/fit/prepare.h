// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/bounds/bounds.h"
#include "kontur/drawing/boundary_point.h"
#include "kontur/drawing/corners.h"
#include "kontur/drawing/drawing.h"
#include "kontur/drawing/reconcile.h"
#include "kontur/drawing/subdivide.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// Constraints nearer to each other are one, of the diameter of what was drawn.
inline constexpr double kMergeFraction = 6e-4;

struct PrepareOptions {
    double quality = 1.0;  ///< fraction of each contour's points to keep (reduce), in (0, 1]
    /// Contours of fewer segments, times quality, are subdivided (subdivide); of more than 100 contours each gets less, at
    /// least a quarter; 0: the paper's rule.
    int least_segments = kLeastSegments;
    bool bounds = true;        ///< keep f on the drawn planes' sides, and end the object beyond the last of them
    double copy_shift_mm = 0;  ///< > 0: coplanar contours get a copy of the first one, shifted by this (paper section 3.1)
    bool gaps = true;          ///< keep normal constraints clear of the opposite wall (find_opposite_walls)
    ReconcileOptions reconcile{};  ///< where contours contradict each other
    /// How far f must be from 0 at interior and exterior points; unset: kMarginFraction of the drawing's diameter.
    std::optional<double> click_margin_mm{};
    Corners corners = Corners::rounded;  ///< what becomes of the corners of closed contours
    /// Faithful corners: from a corner to the point beside it; unset: twice kMergeFraction of the drawing's diameter.
    std::optional<double> corner_spacing_mm{};
    std::optional<Grid> image{};  ///< whose voxels were drawn on: where its border cuts the object off, the object goes on
};

/// The same options with the lengths for a drawing of this diameter where they are not given.
PrepareOptions resolved(PrepareOptions options, double diameter_mm);

/// The contours as the fit sees them.
struct PreparedContours {
    std::vector<BoundaryPoint> points;
    std::vector<Vec3> crossings;          ///< mm, where contours cross themselves
    std::vector<Vec3> between_crossings;  ///< mm, on edges of lobes that hold no point of a contour
    std::vector<Bound> bounds;            ///< beside the lines, beyond the last of them, and at interior and exterior points
    std::vector<std::string> notes;       ///< choices made for the user and doubts, one sentence each
    Ball3 ball;                           ///< mm, the smallest one around all that was drawn
    bool coplanar = false;                ///< all that was drawn lies in one plane, so it alone does not determine a surface
};

/// Reduces, subdivides and orients every contour, finds what bounds the object, and trusts contours less where they
/// contradict each other. Contours in one plane leave f free across it and the paper's system singular: either the bounds or
/// the shifted copy must close the surface. Throws Error(invalid_input) for a contour that encloses nothing, an open one
/// that does not tell on which hand the object lies (find_sides in fit/sides.h), and options outside of their range.
PreparedContours prepare(const Drawing& drawing, const PrepareOptions& options = {}, const Work& work = {});

}  // namespace kontur
