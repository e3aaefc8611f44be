// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// Some structures that touch.
struct TouchingStructures {
    std::vector<ImplicitFunction> each;
    double reach_mm = 0;  ///< half of the way between slices: what has but one of them as near lies beside it, not between
};

/// Places that lie in the union of structures and in none of them.
struct GapPlaces {
    std::vector<Vec3> places_mm;
    std::vector<double> in_union_mm;  ///< how deep each of them lies in the union
};

/// Whether a place (by its index) may become part of a structure (by its).
using MayOwn = std::function<bool(std::size_t place, std::size_t structure)>;

/// To which structure places belong that lie in the union and in none of them: the nearest one of those that may own it.
/// nullopt where the union is less sure of the place than the nearest structure is of the contrary, by its depth
/// f / |grad f|: there the union bulges over the notch at which structures part. nullopt also where fewer than two are
/// within reach.
std::vector<std::optional<std::size_t>> owners_of_gaps(const TouchingStructures& structures, const GapPlaces& gaps,
                                                       const MayOwn& may_own, const Work& work);

}  // namespace kontur
