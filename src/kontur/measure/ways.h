// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: ways along the planes' normals, from one plane to the next and beyond the last ones.

#include <span>
#include <vector>

#include "kontur/measure/plane_look.h"

namespace kontur {

/// Fills in `between`, `beyond` and what lies outside of the ball, from the values at places on the ways.
void check_ways(std::span<const PlaneLook> looks, const ContourSet& set, const DrawingSize& size, const PlaceValues& values,
                SectionCheck& check);

}  // namespace kontur
