// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/bounds/bounds.h"
#include "kontur/shape/contour.h"

namespace kontur {

struct DrawnPlanes;

/// Interior and exterior points as bounds, at least `margin_mm` inside and outside: a point that lies on its side anyway
/// changes nothing, however deep it lies.
std::vector<Bound> click_bounds(const ContourSet& set, double margin_mm);

/// Whether a bound is one of them. They are exact; what planes say has some noise.
inline bool is_click(const Bound& bound) { return bound.noise_mm == 0; }

/// What is contradictory about them, a sentence for each of the first five of a kind and one for the others, points counted
/// from 1: a point on the wrong side of the contours drawn in a plane close by (nearer than half its distance to them), a
/// surface point far from them there, and an interior point within `margin_mm` of an exterior one.
std::vector<std::string> contradictory_clicks(const DrawnPlanes& planes, double margin_mm);

}  // namespace kontur
