// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// How large the part of a drawing is that a place belongs to, against all that was drawn: no contour is a part of something
/// more than fifty times as wide as itself and what is near it. So small lesions far from each other are fitted as if each
/// was drawn alone, and one object as a whole, however small some of its sections. Follows continuously when contours move,
/// and turns and scales with them.
class Extents {
public:
    /// `ball` is the smallest one around all that was drawn.
    Extents(const ContourSet& drawn, const Ball3& ball);

    bool is_one_part() const { return is_one_part_; }

    /// The part's radius over the whole's, in (0, 1]. `place` in mm, anywhere; far from all contours it is their distance
    /// that counts, up to the whole.
    double at(const Vec3& place) const;

private:
    double whole_mm_;
    std::vector<Ball3> contours_;  ///< around each, the largest first
    bool is_one_part_ = true;
};

}  // namespace kontur
