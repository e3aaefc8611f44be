// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/section.h"

namespace kontur {

/// What other planes show where a plane shows what a contour encloses.
enum class PlaneEvidence {
    nothing,  ///< no other plane tells
    object,
    no_object,
};

/// Planes that pass through the inside of the contour decide, by what they show along more than half of their way through
/// it. Without any the next parallel ones before and behind do, where both show the same over more than half of it.
/// `sections` are those of the set, of which number `own` holds the contour.
PlaneEvidence evidence_inside(const Contour& contour, const std::vector<Section>& sections, std::size_t own);

/// The same of a line that leaves so thin a wall within another one, where `evidence_inside` tells nothing: at the last
/// plane, or where the next one on one of the sides is `doubtful`, too, and is passed over. A wall is about as thick at its
/// end as at its sides, so there is none beside planes that show object over a depth of three walls, where neither side
/// shows a cavity. Says object then, else nothing.
PlaneEvidence evidence_beyond(const Contour& contour, const std::vector<Section>& sections, std::size_t own,
                              const std::vector<bool>& doubtful, double wall_mm);

}  // namespace kontur
