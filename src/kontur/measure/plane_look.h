// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: a drawn plane and the result's section with it.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "kontur/base/smallest_ball.h"
#include "kontur/base/work.h"
#include "kontur/measure/section_check.h"
#include "kontur/measure/section_raster.h"
#include "kontur/shape/section.h"

namespace kontur {

/// The drawing's lengths, which the check's limits are fractions of.
struct DrawingSize {
    Ball3 ball;
    double tolerance_mm;  ///< wrong places less deep do not count
};

/// Pixels of a plane, what is drawn there and what the result has.
struct Sheet {
    PixelLattice lattice;
    std::vector<std::uint8_t> filled;
    std::vector<std::uint8_t> counted;  ///< empty: all of them
    std::vector<double> values;         ///< of the result; far ones of a block of like pixels are those of its corner
    std::vector<double> depths;         ///< where result and drawing differ, mm to the nearest line; else 0

    bool counts(std::size_t pixel) const { return counted.empty() || counted[pixel] != 0; }
    bool is_inside(std::size_t pixel) const { return counts(pixel) && values[pixel] > 0; }
    bool differs(std::size_t pixel) const { return counts(pixel) && (values[pixel] > 0) != (filled[pixel] != 0); }
};

/// A plane with its lines. Without a section it was given as empty.
class PlaneLook {
public:
    PlaneLook(const Section& section, const ContourSet& set, const DrawingSize& size);
    PlaneLook(const Plane& empty, double area_mm2, const DrawingSize& size);

    const Plane& plane() const { return plane_; }
    const Section* section() const { return section_; }
    std::optional<std::size_t> contour() const;
    double area_mm2() const { return area_mm2_; }
    double extent_mm() const { return raster_.extent_mm; }
    double pixel_mm() const { return near_.lattice.step_mm; }
    const Box2& box() const { return raster_.box; }
    /// Whether the drawing has object at a place of the plane.
    bool contains(const Point2& p) const { return raster_.contains(p); }
    /// To the nearest line of a closed contour; infinity in an empty plane.
    double clearance(const Point2& p) const;
    /// Middles of some pixels of the fill, at equal steps.
    std::vector<Vec3> filled_places(std::size_t most) const;

    /// About the lines, and around that to a quarter beyond the drawing's ball.
    Sheet& near() { return near_; }
    Sheet& far() { return far_; }
    const Sheet& near() const { return near_; }
    const Sheet& far() const { return far_; }

    /// Fills in the depths of wrong pixels. Those whose nearest line is an open one get 0: they do not count.
    void measure_depths();

private:
    void lay_far_sheet(double step_mm, const DrawingSize& size);
    double depth_at(const Point2& p, double value) const;

    const Section* section_ = nullptr;
    Plane plane_;
    double area_mm2_ = 0;
    SectionRaster raster_;
    std::optional<SectionSearch> search_;
    std::vector<std::pair<Point2, Point2>> open_edges_;
    Sheet near_, far_;
};

/// Fills in the values of all sheets: every third pixel first, then all where these or the drawing differ. Where a pixel's
/// side looks wrong `exact` is asked.
void look(std::span<PlaneLook> looks, const PlaceValues& values, const PlaceValues& exact, const DrawingSize& size,
          const Work& work);

}  // namespace kontur
