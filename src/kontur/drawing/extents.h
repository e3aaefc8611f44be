// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// How large the part of a drawing is that a place belongs to, against all that was drawn. Contours are joined, the nearest
/// first. Two groups of them are two parts where the gap is three and a half radii of the larger one, and less and less so
/// down to two radii, more than evenly spaced rings leave. With a single contour they are two from fifty radii on. So
/// lesions far from each other are fitted as if each was drawn alone, and one object as a whole, however small some of its
/// sections. Follows continuously when contours move, and turns and scales with them.
class Extents {
public:
    /// `ball` is the smallest one around all that was drawn.
    Extents(const ContourSet& drawn, const Ball3& ball);

    bool is_one_part() const { return is_one_part_; }

    /// The part's radius over the whole's, in (0, 1]. `place` in mm, anywhere; far from all contours it is their distance
    /// that counts, up to the whole.
    double at(const Vec3& place) const;

    /// The contours of the parts that have nothing in common, ascending in each; the first contour's part is the first.
    const std::vector<std::vector<std::size_t>>& parts() const { return parts_; }

private:
    void join(const ContourSet& drawn);
    void set_part(const std::vector<std::size_t>& contours, double radius_mm);

    double whole_mm_;
    std::vector<Ball3> contours_;  ///< around each
    std::vector<double> part_mm_;  ///< for each contour the radius of its part
    std::vector<std::vector<std::size_t>> parts_;
    bool is_one_part_ = true;
};

}  // namespace kontur
