// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/plane_bounds.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"

namespace kontur {
namespace {

constexpr double kInside = 0.05;       // of how deep a place lies inside: the surface may pass close above it
constexpr double kInsideNoise = 0.03;  // of the same
constexpr double kSurelyNear = 0.25;   // of the distance to the lines: what others show nearer than that decides

/// How far a place is known to lie outside, and how much of that is to be believed.
struct Outside {
    double distance_mm;
    double belief;
};

class PlaneBounds {
public:
    PlaneBounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t index)
        : ball_(planes.ball), regions_(regions), own_(regions[index]), normal_(own_.section.plane.normal) {}

    std::vector<Bound> find() const {
        std::vector<Bound> bounds;
        append_inside(bounds);
        const Plane& plane = own_.section.plane;
        const PlaneLattice lattice(ball_, plane.distance_to(ball_.center));
        const SectionAxes axes(own_.section);
        const Point2 center = axes.from_plane(plane.to_uv(ball_.center));
        lattice.for_each_place([&](double x, double y) {
            append(axes.to_plane({center[0] + x, center[1] + y}), lattice, bounds);
        });
        return bounds;
    }

private:
    void append_inside(std::vector<Bound>& bounds) const {
        for (const Probe& probe : own_.inside)
            bounds.push_back({.position = own_.section.plane.from_uv(probe.at),
                              .least_mm = kInside * probe.depth,
                              .noise_mm = kInsideNoise * probe.depth});
    }

    void append(const Point2& at, const PlaneLattice& lattice, std::vector<Bound>& bounds) const {
        if (own_.search.contains(at)) return;
        const double clear = clearance(at);
        if (clear < lattice.step_mm() / 4) return;
        const Vec3 place = own_.section.plane.from_uv(at);
        const Outside outside = outside_of(place, clear);
        if (outside.belief >= kLeastBelief) bounds.push_back(lattice.outside(place, outside.distance_mm, outside.belief));
    }

    /// A crossing hides as much around it as the lines are away from it.
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
            if (share * apart_mm >= nearest && surely(apart_mm / clear) <= std::min(shown_before, shown_behind)) continue;
            other.places.visit_within(place, clear, [&](const Vec3& shown) {
                const double apart = distance(shown, place);
                if (apart == 0) return;
                nearest = std::min(nearest, share * apart);
                const double ahead = dot(shown - place, normal_);
                double& side = ahead > 0 ? shown_before : shown_behind;
                if (const double most = surely(apart / clear); most > side)
                    side = std::max(side, most * smooth_step(0, 0.5, std::abs(ahead / apart)));
            });
        }
        return {nearest, 1 - shown_before * shown_behind};
    }

    static double surely(double share_of_clear) { return 1 - smooth_step(kSurelyNear, 1, share_of_clear); }

    struct Near {
        double apart_mm;  ///< no place of it is nearer
        std::size_t region;
    };

    /// The other regions that may have places within a distance.
    std::vector<Near> nearest_first(const Vec3& place, double within_mm) const {
        std::vector<Near> near;
        constexpr double kRounding = 1 + 1e-9;
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            const double off = std::abs(regions_[r].section.plane.distance_to(place));
            if (&regions_[r] == &own_ || off > kRounding * within_mm) continue;
            const double apart = distance(regions_[r].ball.center, place) - regions_[r].ball.radius;
            if (apart < within_mm) near.push_back({std::max(apart, 0.0), r});
        }
        std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.apart_mm < b.apart_mm; });
        return near;
    }

    const Ball3& ball_;
    const std::vector<DrawnRegion>& regions_;
    const DrawnRegion& own_;
    Vec3 normal_;
};

}  // namespace

std::vector<Bound> plane_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region) {
    return PlaneBounds(planes, regions, region).find();
}

}  // namespace kontur
