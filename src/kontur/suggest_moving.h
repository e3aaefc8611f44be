// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/moving/moving_function.h"
#include "kontur/sureness/suggest_plane.h"
#include "kontur/volume_curve.h"

namespace kontur {

/// What is known of an object that moves, as segment_moving made it.
struct MotionEvidence {
    std::span<const double> times;  ///< of the image's frames
    const VolumeCurve& volumes;     ///< at these times
    const MovingFunction& function;
    const std::vector<DrawnMoment>& moments;
};

/// When and where to draw next.
struct MovingSuggestion {
    std::size_t frame = 0;  ///< of the times, from 0
    Plane plane;            ///< its origin lies amid the expected outline
    std::optional<ImageSlice> slice{};
};

/// The frames whose volumes are least sure, each with a plane; best first. Each takes the frames beside it along, so that
/// the next one lies elsewhere. At a frame with contours in all planes the plane is that of suggest_planes. At others it is
/// one in which something was drawn at other moments: that in which the surface moves most between the moments around.
/// While a moment has too few planes for intervals, it is that of the fewest. Fewer than asked for where nothing is left.
std::vector<MovingSuggestion> suggest_moving(const MotionEvidence& evidence, std::size_t count = 1,
                                             const SuggestPlaneOptions& options = {}, const Work& work = {});

}  // namespace kontur
