// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/near_lines.h"

namespace kontur {

/// Pairs of contours that cross, or of which one is the next around the other, with less than a third of the larger one's
/// area between them. A plane through a ball with a round cavity in its middle shows so thin a wall only where planes that
/// miss the cavity show less than half of that. O(n log n) in points and pairs.
std::vector<NearLines> find_near_lines(const std::vector<Contour>& contours, const Nesting& nesting);

/// Indices that belong together.
class Groups {
public:
    explicit Groups(std::size_t count);
    void unite(std::size_t a, std::size_t b);
    /// The least index of the group.
    std::size_t of(std::size_t i) const;

private:
    std::vector<std::size_t> least_;
};

/// Contours that were taken for one line are in a group.
Groups groups_of(const std::vector<NearLines>& pairs, std::size_t contours);

}  // namespace kontur
