// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/near_lines.h"

namespace kontur {

/// What `apply_fill_rule` did. Indices are those before any contour was taken out, of near lines those after it.
struct FillChanges {
    std::size_t holes = 0;    ///< contours that became holes because of where they lie
    std::size_t removed = 0;  ///< contours taken out because they lie inside the object (FillRule::declared)
    std::vector<std::pair<std::size_t, std::size_t>> crossings;  ///< as Nesting's, without those of near lines
    std::vector<NearLines> near_lines;     ///< taken for one line, or perhaps one, where a hole leaves a thin wall
    std::vector<std::size_t> stray_holes;  ///< declared as holes where their plane shows no object
};

/// "contours 1 and 2 overlap in part (and 3 more such pairs); what any of them encloses is filled", of at least one pair.
std::string overlap_sentence(const std::vector<std::pair<std::size_t, std::size_t>>& pairs);

/// Makes every contour's `hole` say on which of its sides the object lies. Doing it again changes nothing. The
/// tolerance of `find_nesting` is `kSamePlane` of the set's diameter.
///
/// Two lines of a plane that lie near to each other (find_near_lines) may be one line, drawn twice. They are one
/// where they cross. They are also one where other planes show the same inside of both as between them
/// (evidence_inside). Otherwise the space between them is a wall, and always where the inner one is declared as a
/// hole.
FillChanges apply_fill_rule(ContourSet& set, FillRule rule);

}  // namespace kontur
