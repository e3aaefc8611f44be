// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/grid.h"
#include "kontur/sureness/expected_dice.h"
#include "kontur/sureness/image_slice.h"

namespace kontur {

struct SurfaceEvidence;

struct SuggestPlaneOptions {
    PlaneChoice planes = PlaneChoice::any;
    std::optional<Grid> grid{};  ///< of the image drawn on; its slices are candidates, and needed for `image_slices`
    std::vector<Plane> avoid{};  ///< not these, nor their near copies: the user has skipped them
};

struct SuggestedPlane {
    Plane plane;                        ///< its origin lies amid the predicted outline
    std::optional<ImageSlice> slice{};  ///< of the image, if the plane is one
    double gain = 0;  ///< share of the surface's distance from what is drawn that a contour here takes away, 0 to 1
    ExpectedDice before, after;  ///< without the contour and with it; zero where the surface is not known
};

struct PlaneSuggestions {
    std::vector<SuggestedPlane> planes;  ///< best first, each for what the ones before it leave; fewer than asked for when
                                         ///< no plane that meets the object is far enough from all drawn ones
    std::int64_t candidates = 0;         ///< planes weighed
    std::int64_t distances = 0;          ///< computed for them: what it cost
};

/// Where to draw next. While all drawn planes are parallel: at right angles to them, through the middle of the longest
/// contour and along its long axis. As the third and fourth plane, unless slices of the image are asked for: through the
/// three largest clusters of places far from the contours (far_places.h). After that: the plane that lowers the surface's
/// mean distance from the contours most. Each place counts by 1 / |grad f| and by the error that the image leaves. It is the
/// best of candidate_planes, shifted and tilted as long as that gains. Never a plane that misses the fitted surface, or runs
/// within 3 % of its diameter along a drawn or an empty one. Turns, moves and scales with the drawing; the same bytes for
/// any number of threads. Throws Error(invalid_input) without contours, for `image_slices` without a grid, and for `count`
/// 0.
PlaneSuggestions suggest_planes(const SurfaceEvidence& evidence, const ContourSet& contours, std::size_t count = 1,
                                const SuggestPlaneOptions& options = {}, const Work& work = {});

}  // namespace kontur
