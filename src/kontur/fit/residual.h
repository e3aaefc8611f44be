// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// How far the fitted surface passes from the drawn points, in mm.
struct Residual {
    double max_mm = 0;
    double rms_mm = 0;
    std::size_t worst_contour = 0;  ///< index of the contour with the largest residual
};

/// First-order distance |f| / |grad f| at every drawn point of a border, whether or not it took part in the fit (Taubin
/// 1991). |grad f|, about 1 near the surface, is taken as at least 0.1, so that a flat spot of f does not count as
/// infinitely far. Lines that are no border in their own plane (inner_lines.h) do not count: the surface has to leave them.
/// Nor do those along the border of the `image` that was drawn on. Holes are known (apply_fill_rule).
Residual residual(const ImplicitFunction& function, const ContourSet& set, const Work& work = {},
                  const std::optional<Grid>& image = {});

/// The same in the middle of every edge longer than `long_mm`, where nothing was drawn but the line: `rms_mm` is of these.
Residual residual_between_points(const ImplicitFunction& function, const ContourSet& set, double long_mm,
                                 const Work& work = {}, const std::optional<Grid>& image = {});

}  // namespace kontur
