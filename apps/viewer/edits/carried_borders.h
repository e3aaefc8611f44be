// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "viewer/edits/slice_edges.h"
#include "viewer/model/model.h"

namespace kontur::viewer {

/// How a closed line went from one course to another, in one plane: places along what has changed lie as far along the new
/// part as they did along the old one.
class LineChange {
public:
    LineChange(const DrawnContour& before, const DrawnContour& after);

    /// Where what is drawn at `p` goes: with the nearest place of the old line where it is within `near_mm` of it, less and
    /// less up to twice as far. nullopt: it stays.
    std::optional<Vec3> carried(const Vec3& p, double near_mm) const;

private:
    struct Part {
        std::vector<Vec3> before, after;  ///< from where both lines part to where they meet
    };
    std::vector<Vec3> before_;
    std::vector<std::size_t> part_of_;  ///< of each edge of the old line; kStays for those that have not changed
    std::vector<Part> parts_;
    Box3 changed_;  ///< of the old line
};

/// A neighbour's contour as it is where its line runs along that of a contour in its plane, which goes from `before` to
/// `after`; nullopt where nothing of it moves. Stretches that move become free.
std::optional<DrawnContour> carried_along(const DrawnContour& neighbor, const DrawnContour& before,
                                          const DrawnContour& after, double near_mm, SliceEdges& edges);

}  // namespace kontur::viewer
