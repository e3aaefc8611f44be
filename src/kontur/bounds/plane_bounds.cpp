// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/plane_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"

namespace kontur {
namespace {

// Without these bounds 35 drawings by hand lose .0012, one .017; 71 exact ones do not tell.
constexpr double kInside = 0.05;       // of how deep a place lies inside: the surface may pass close above it
constexpr double kInsideNoise = 0.03;  // of the same
constexpr double kSurelyNear = 0.25;   // of the distance to the lines: what others show nearer than that decides

/// How far a place is known to lie outside, and how much of that is to be believed.
struct Outside {
    double distance_mm;
    double belief;
};

/// A finer lattice over what is drawn in a plane and beside it: islands of an eighth of its width are seen.
class Around {
public:
    Around(const Section& section, const SectionAxes& axes) {
        // Across the section. 24 see islands of 8 mm2 that 16 do not in one drawing of 28, and the fit takes a fifth longer.
        constexpr double kSteps = 16;
        constexpr double kMargin = 0.25;  // of its width, on each side
        Box2 box;
        for (const Polygon2& outline : section.outlines)
            for (const Point2& p : outline) box.extend(axes.from_plane(p));
        const double width = std::max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
        step_mm_ = width / kSteps;
        for (const std::size_t axis : {0u, 1u}) {
            middle_[axis] = (box.low[axis] + box.high[axis]) / 2;
            steps_[axis] = static_cast<int>(((box.high[axis] - box.low[axis]) / 2 + kMargin * width) / step_mm_);
        }
    }

    double step_mm() const { return step_mm_; }

    bool covers(const Point2& at) const {
        return std::abs(at[0] - middle_[0]) <= steps_[0] * step_mm_ && std::abs(at[1] - middle_[1]) <= steps_[1] * step_mm_;
    }

    /// Symmetric about the middle: the axes' signs mean nothing.
    template <class Visit>
    void for_each_place(const Visit& visit) const {
        for (int row = -steps_[1]; row <= steps_[1]; ++row)
            for (int column = -steps_[0]; column <= steps_[0]; ++column)
                visit(Point2{middle_[0] + column * step_mm_, middle_[1] + row * step_mm_});
    }

private:
    double step_mm_ = 0;
    Point2 middle_{};
    int steps_[2] = {};
};

class PlaneBounds {
public:
    PlaneBounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t index,
                const std::vector<TubeWay>& ways)
        : image_(planes.image),
          ball_(planes.ball),
          regions_(regions),
          own_(regions[index]),
          normal_(own_.section.plane.normal) {
        for (const TubeWay& way : ways)
            if (way.from.region != index && way.to.region != index) ways_.push_back(&way);
    }

    std::vector<Bound> find() const {
        const Plane& plane = own_.section.plane;
        const PlaneLattice lattice(ball_, plane.distance_to(ball_.center));
        const SectionAxes axes(own_.section);
        const Around around(own_.section, axes);
        std::vector<Bound> bounds;
        append_inside(bounds);
        around.for_each_place([&](const Point2& at) { append(axes.to_plane(at), around.step_mm(), bounds); });
        const Point2 center = axes.from_plane(plane.to_uv(ball_.center));
        lattice.for_each_place([&](double x, double y) {
            if (const Point2 at{center[0] + x, center[1] + y}; !around.covers(at))
                append(axes.to_plane(at), lattice.step_mm(), bounds);
        });
        for (const double side : {-1.0, 1.0})
            if (const DrawnRegion* const beside = parallel_beside(side))
                for (const Probe& probe : beside->inside)
                    append(plane.to_uv(beside->section.plane.from_uv(probe.at)), lattice.step_mm(), bounds);
        return bounds;
    }

private:
    void append_inside(std::vector<Bound>& bounds) const {
        for (const Probe& probe : own_.inside)
            bounds.push_back({.position = own_.section.plane.from_uv(probe.at),
                              .least_mm = kInside * probe.depth,
                              .noise_mm = kInsideNoise * probe.depth});
    }

    /// The nearest plane on a side that lies parallel to this one; none: nullptr. Where it shows the object and this one
    /// does not, an island would grow between the places of the lattices.
    const DrawnRegion* parallel_beside(double side) const {
        const DrawnRegion* nearest = nullptr;
        double least = std::numeric_limits<double>::infinity();
        for (const DrawnRegion& other : regions_) {
            if (&other == &own_ || crossing(normal_, other.section.plane.normal) == 1) continue;
            const double ahead = side * own_.section.plane.distance_to(other.ball.center);
            if (ahead > 0 && ahead < least) least = ahead, nearest = &other;
        }
        return nearest;
    }

    void append(const Point2& at, double step_mm, std::vector<Bound>& bounds) const {
        if (own_.search.contains(at)) return;
        const double clear = clearance(at);
        if (clear < step_mm / 4) return;
        const Vec3 place = own_.section.plane.from_uv(at);
        if (is_beyond_cut(place)) return;
        const Outside outside = beside_tubes(place, own_.search.clearance(at), outside_of(place, clear));
        if (outside.belief >= kLeastBelief)
            bounds.push_back(outside_bound(place, outside.distance_mm, step_mm, outside.belief));
    }

    /// Whether a place lies beyond the image's border where that cuts what was drawn off: nothing was seen there.
    bool is_beyond_cut(const Vec3& place) const {
        if (!image_ || image_->contains(place)) return false;
        const Vec3 border = image_->nearest(place);
        const Point2 at = own_.section.plane.to_uv(border);
        return own_.search.contains(at) || own_.search.clearance(at) < image_->voxel_mm();
    }

    /// A crossing hides as much around it as the lines are away from it. Without, 35 drawings by hand lose .0028, one .013;
    /// 71 exact ones do not tell.
    double clearance(const Point2& at) const {
        double clear = own_.search.clearance(at);
        for (const auto& [crossing, from_lines] : own_.crossings)
            clear = std::min(clear, std::hypot(at[0] - crossing[0], at[1] - crossing[1]) - from_lines);
        return clear;
    }

    Outside outside_of(const Vec3& place, double clear) const {
        double nearest = clear, shown_before = 0, shown_behind = 0;
        for (const auto& [apart_mm, index] : nearest_first(place, clear)) {
            const DrawnRegion& other = regions_[index];
            const double share = outside_per_mm(normal_, other.section.plane.normal);
            // Who draws rings across a vessel leaves out the other turns that their planes cut, so what other planes show
            // near by is believed; a parallel one has to be twice as near. As near, and combs and letters grow islands;
            // three times, and a helix falls apart.
            const double nearer = 2 - crossing(normal_, other.section.plane.normal);
            if (share * apart_mm >= nearest && surely(nearer * apart_mm / clear) <= std::min(shown_before, shown_behind))
                continue;
            double before = 0, behind = 0;
            other.places.visit_within(place, clear, [&](const Vec3& shown) {
                const double apart = distance(shown, place);
                if (apart == 0) return;
                nearest = std::min(nearest, share * apart);
                const double ahead = dot(shown - place, normal_);
                double& side = ahead > 0 ? before : behind;
                if (const double most = surely(nearer * apart / clear); most > side)
                    side = std::max(side, most * smooth_step(0, 0.5, std::abs(ahead / apart)));
            });
            if (before > 0 && behind > 0 && !other.search.contains(other.section.plane.to_uv(place))) {
                // One plane shows both sides, and the gap between them. Without, a large comb loses 14 % of
                // a section.
                const double least = std::min(before, behind);
                before -= least;
                behind -= least;
            }
            shown_before = std::max(shown_before, before);
            shown_behind = std::max(shown_behind, behind);
        }
        return {nearest, 1 - shown_before * shown_behind};
    }

    /// The same where tubes of other planes pass near the place.
    Outside beside_tubes(const Vec3& place, double from_lines, Outside outside) const {
        for (const TubeWay* const way : ways_) {
            const double hides = way->hides(normal_) * smooth_step(kHidden, 2 * kHidden, from_lines / way->length_mm);
            if (hides == 0) continue;
            const double apart = way->distance_mm(place) - way->radius_mm();
            if (apart >= outside.distance_mm) continue;
            outside.distance_mm += hides * (std::max(apart, 0.0) - outside.distance_mm);
            outside.belief *= 1 - hides * (1 - smooth_step(0, way->radius_mm(), apart));
        }
        return outside;
    }

    static double surely(double share_of_clear) { return 1 - smooth_step(kSurelyNear, 1, share_of_clear); }

    struct Near {
        double apart_mm;  ///< no place of it is nearer
        std::size_t region;
    };

    /// The other regions that may have places within a distance.
    std::vector<Near> nearest_first(const Vec3& place, double within_mm) const {
        std::vector<Near> near;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            const double off = std::abs(regions_[r].section.plane.distance_to(place));
            if (&regions_[r] == &own_ || off > kRoundedUp * within_mm) continue;
            const double apart = distance(regions_[r].ball.center, place) - regions_[r].ball.radius;
            if (apart < within_mm) near.push_back({std::max(apart, 0.0), r});
        }
        std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.apart_mm < b.apart_mm; });
        return near;
    }

    const std::optional<ImageBox>& image_;
    const Ball3& ball_;
    const std::vector<DrawnRegion>& regions_;
    const DrawnRegion& own_;
    Vec3 normal_;
    std::vector<const TubeWay*> ways_;  ///< of other planes
};

}  // namespace

std::vector<Bound> plane_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                                const std::vector<TubeWay>& ways) {
    return PlaneBounds(planes, regions, region, ways).find();
}

}  // namespace kontur
