// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace kontur {

struct SurfaceEvidence;

/// Overlap with the truth that a mask of the surface may be expected to have; the true one lies within [low, high] in 90 %.
struct ExpectedDice {
    double value = 0, low = 0, high = 0;
};

/// From how far the surface is from what was drawn, over its volume; 0 without a surface.
ExpectedDice expected_dice(const SurfaceEvidence& evidence);

/// The same if the samples lay this far from the nearest line, in mm: after a further contour, say.
ExpectedDice expected_dice(const SurfaceEvidence& evidence, std::span<const double> distances_mm);

/// How many planes beyond those drawn until this Dice is expected; 0 where it is already.
std::size_t planes_to(const ExpectedDice& now, std::size_t planes_drawn, double target);

}  // namespace kontur
