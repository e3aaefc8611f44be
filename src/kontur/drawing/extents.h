// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// How large the part of a drawing is that a place belongs to, relative to the whole. Contours are joined, the nearest
/// first. Two groups are two parts where the gap is at least three and a half radii of the larger one, and one part up to
/// two radii, which is more than evenly spaced rings leave. A single contour is a part of its own from fifty radii on. So
/// distant lesions are fitted as if each was drawn alone, but small sections of one object are not. Continuous in the
/// contours; turns and scales with them.
class Extents {
public:
    /// `ball` is the smallest one around all that was drawn.
    Extents(const ContourSet& set, const Ball3& ball);

    bool is_one_part() const { return is_one_part_; }

    /// The part's radius over the whole's, in (0, 1]. `place` in mm, anywhere; far from all contours it is their distance
    /// that counts, up to the whole.
    double at(const Vec3& place) const;

    /// The contours of the parts that have nothing in common, ascending in each; the first contour's part is the first.
    const std::vector<std::vector<std::size_t>>& parts() const { return parts_; }

private:
    void join(const ContourSet& set);
    void set_part(const std::vector<std::size_t>& contours, double radius_mm);

    double whole_mm_;
    std::vector<Ball3> contours_;  ///< around each
    std::vector<double> part_mm_;  ///< for each contour the radius of its part
    std::vector<std::vector<std::size_t>> parts_;
    bool is_one_part_ = true;
};

}  // namespace kontur
