// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/plane_bounds.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

constexpr double kReach = 1.25;   // radii of the ball
constexpr double kStep = 0.125;   // of its radius
constexpr double kValue = 0.25;   // of the distance outside; walls that stand oblique to the plane are nearer than its lines
constexpr double kNoise = 0.1;    // of the distance outside
constexpr double kInside = 0.05;  // of how deep a place lies inside: the surface may pass close above it
constexpr double kInsideNoise = 0.03;  // of the same
constexpr double kParallel = 0.1;      // how far outside a place is, for each mm from a parallel plane that shows the object
constexpr double kSlantedSine2 = 0.25;  // 30 degrees: from there on the distance to a plane counts in full
constexpr double kSurelyNear = 0.25;    // of the distance to the lines: what others show nearer than that decides

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
        const double off = plane.distance_to(ball_.center), reach = kReach * ball_.radius, step = kStep * ball_.radius;
        if (std::abs(off) >= reach) return bounds;
        const double extent = std::sqrt(reach * reach - off * off);
        const SectionAxes axes(own_.section);
        const Point2 center = axes.from_plane(plane.to_uv(ball_.center));
        const auto steps = static_cast<int>(extent / step);
        for (int row = -steps; row <= steps; ++row)
            for (int column = -steps; column <= steps; ++column)
                if (std::hypot(row * step, column * step) <= extent)
                    append(axes.to_plane({center[0] + column * step, center[1] + row * step}), step, bounds);
        return bounds;
    }

private:
    void append_inside(std::vector<Bound>& bounds) const {
        for (const Probe& probe : own_.inside)
            bounds.push_back({.position = own_.section.plane.from_uv(probe.at),
                              .least_mm = kInside * probe.depth,
                              .noise_mm = kInsideNoise * probe.depth});
    }

    void append(const Point2& at, double step, std::vector<Bound>& bounds) const {
        if (own_.search.contains(at)) return;
        const double clear = clearance(at);
        if (clear < step / 4) return;
        const Vec3 place = own_.section.plane.from_uv(at);
        const Outside outside = outside_of(place, clear);
        if (outside.belief < kLeastBelief) return;
        bounds.push_back({.position = place,
                          .most_mm = -kValue * outside.distance_mm,
                          .noise_mm = faded(kNoise * std::max(outside.distance_mm, step), outside.belief)});
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
        for (const DrawnRegion& other : regions_) {
            if (&other == &own_ || distance(other.ball.center, place) >= clear + other.ball.radius) continue;
            const double cosine = dot(normal_, other.section.plane.normal);
            const double share = kParallel + (1 - kParallel) * smooth_step(0, kSlantedSine2, 1 - cosine * cosine);
            for (const Vec3& shown : other.places) {
                const double apart = distance(shown, place);
                if (!(apart > 0 && apart < clear)) continue;
                nearest = std::min(nearest, share * apart);
                const double ahead = dot(shown - place, normal_) / apart;
                double& side = ahead > 0 ? shown_before : shown_behind;
                side =
                    std::max(side, (1 - smooth_step(kSurelyNear, 1, apart / clear)) * smooth_step(0, 0.5, std::abs(ahead)));
            }
        }
        return {nearest, 1 - shown_before * shown_behind};
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
