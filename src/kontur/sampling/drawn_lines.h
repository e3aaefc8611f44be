// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"

namespace kontur {

class PointTree;

/// Everything that was drawn, to ask how far away it is, and in which planes. Cheap to copy, safe to read from any thread.
class DrawnLines {
public:
    /// Nothing was drawn.
    DrawnLines() : DrawnLines(ContourSet{}) {}
    /// Lines are stood for by points 0.4 % of the drawing's diameter apart, so distances are exact to a fifth of a percent.
    explicit DrawnLines(const ContourSet& contours);

    /// mm to the nearest line or single surface point; infinity when nothing was drawn.
    double distance_to(const Vec3& p) const noexcept;
    /// Of every point, in bulk; the same bytes for any number of threads.
    std::vector<double> distances_to(const std::vector<Vec3>& points, const Work& work = {}) const;

    /// The planes that closed and open contours lie in, in the order drawn. What lies within 2 degrees and 0.5 % of the
    /// diameter of an earlier plane is the same plane drawn again.
    const std::vector<Plane>& planes() const { return planes_; }
    /// Of the lines in each of those planes.
    const std::vector<double>& lengths_mm() const { return lengths_mm_; }

private:
    std::shared_ptr<const PointTree> tree_;
    std::vector<Plane> planes_;
    std::vector<double> lengths_mm_;
};

/// The points of a contour's line at most `step_mm` apart, its own among them.
std::vector<Vec3> dense_points(const Contour& contour, double step_mm);

}  // namespace kontur
