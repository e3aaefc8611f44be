// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kontur/drawing/boundary_point.h"
#include "kontur/drawing/drawn_planes.h"

namespace kontur {

/// Lines that are no border in their own plane: where contours touch or overlap, or one runs back along itself, the object
/// lies on both sides of a line, and where a hole leaves the object, on neither.
class InnerLines {
public:
    /// `planes` must outlive it.
    explicit InnerLines(const DrawnPlanes& planes);

    /// Whether the contour runs within the object, or within a hole, at one of its places. `across` is a unit vector of the
    /// plane, across the line; either sign. A cleft of up to `cleft_mm` does not part the object. False for open contours.
    bool has(std::size_t contour, const Vec3& place, const Vec3& across, double cleft_mm) const;

private:
    const DrawnPlanes& planes_;
    std::vector<std::optional<std::size_t>> section_of_;  ///< for each contour; none for open ones
    std::vector<SectionSearch> searches_;
};

/// Leaves out the points of inner lines. A cleft of up to `cleft_mm` times the point's extent is none. What remains of a
/// ring is open lines; their first and last point, where the border turns onto another line, have no direction.
void leave_out_inner_lines(const DrawnPlanes& planes, double cleft_mm, std::vector<BoundaryPoint>& points);

}  // namespace kontur
