// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/section.h"

namespace kontur {

/// What other planes show where a plane shows what a contour encloses.
enum class Seen {
    nothing,  ///< no other plane tells
    object,
    no_object,
};

/// Planes that pass through the inside of the contour decide, by what they show along more than half of their way through
/// it. Without any the next parallel ones before and behind do, where both show the same over more than half of it.
/// `sections` are those of the set, of which number `own` holds the contour.
Seen seen_inside(const Contour& contour, const std::vector<Section>& sections, std::size_t own);

}  // namespace kontur
