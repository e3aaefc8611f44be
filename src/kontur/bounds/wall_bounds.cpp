// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/wall_bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"

namespace kontur {
namespace {

// Mean Dice of 42 tubes, arches and stacks that end so: .949, .811 without these bounds. 444 drawings of organs: within
// .0005.
constexpr double kApart = 1.5;             // of the region's inscribed radius; half .933, twice .950
constexpr double kDepths[] = {0.5, 1, 2};  // of the same
constexpr double kBulge = 0.1;             // of the depth; half .947, twice .934

/// A plane ahead of a region, and how much of the region it does not show.
struct PlaneAhead {
    double distance_mm;
    double parallel;  ///< 1, and 0 from 20 degrees on
    double empty;     ///< share of the region
};

class Walls {
public:
    Walls(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, const DrawnRegion& own, double sign)
        : regions_(regions), own_(own), up_(sign * own.section.plane.normal), depth_(deepest(own.inside)) {
        for (const DrawnRegion& other : regions)
            if (&other != &own)
                look_at(other.section.plane,
                        [&](const Vec3& place) { return other.search.contains(other.section.plane.to_uv(place)); });
        for (const Plane& empty : planes.set.empty_planes) look_at(empty, [](const Vec3&) { return false; });
        std::ranges::sort(ahead_, {}, &PlaneAhead::distance_mm);
    }

    /// How surely the object ends close beyond the region.
    double belief() const {
        double most = 0, open = 1;
        for (const PlaneAhead& plane : ahead_) {
            const double close = 1 - smooth_step(0, kApart, plane.distance_mm / depth_);
            most = std::max(most, open * plane.parallel * close * smooth_step(0.5, 1, plane.empty));
            open *= 1 - plane.parallel * (1 - plane.empty);
        }
        return most;
    }

    std::vector<Bound> bounds(double belief) const {
        std::vector<Bound> bounds;
        const std::optional<Behind> next = next_behind();
        for (const Polygon2& line : own_.section.outlines)
            for_each_step(line, kLinePlaces, [&](const Point2& p) {
                const Vec3 rim = own_.section.plane.from_uv(p);
                const double flare = next ? slope(*next, rim) : 0;
                for (const double share : kDepths) {
                    const double below = share * depth_;
                    if (next && below > next->distance_mm / 2) break;
                    bounds.push_back({.position = rim - below * up_,
                                      .most_mm = below * flare + kBulge * below,
                                      .noise_mm = faded(kSureNoise * below, belief)});
                }
            });
        return bounds;
    }

private:
    template <class Shows>
    void look_at(const Plane& plane, const Shows& shows) {
        const double parallel = 1 - crossing(up_, plane.normal);
        if (parallel == 0 || own_.inside.empty()) return;
        if (std::abs(plane.distance_to(own_.ball.center)) > kApart * depth_ + own_.ball.radius) return;  // most of them
        const double cosine = dot(up_, plane.normal);
        double distance = 0, empty = 0;
        for (const Probe& probe : own_.inside) {
            const Vec3 place = own_.section.plane.from_uv(probe.at);
            const double ahead = -plane.distance_to(place) / cosine;
            distance += ahead;
            if (std::abs(ahead) < kApart * depth_ && !shows(place + ahead * up_)) ++empty;
        }
        const auto count = static_cast<double>(own_.inside.size());
        if (distance > 0 && distance / count < kApart * depth_)
            ahead_.push_back({distance / count, parallel, empty / count});
    }

    struct Behind {
        const DrawnRegion* region;
        double distance_mm;
    };

    /// The nearest region that follows on the object's side.
    std::optional<Behind> next_behind() const {
        std::optional<Behind> next;
        for (const DrawnRegion& other : regions_) {
            const double cosine = dot(up_, other.section.plane.normal);
            if (&other == &own_ || crossing(up_, other.section.plane.normal) > 0.5) continue;
            const double behind = other.section.plane.distance_to(own_.ball.center) / cosine;
            if (behind > 0 && (!next || behind < next->distance_mm)) next = Behind{&other, behind};
        }
        return next;
    }

    /// How much deeper in the next section a place of the rim lies, per mm on the way there.
    static double slope(const Behind& next, const Vec3& rim) {
        const Point2 at = next.region->section.plane.to_uv(rim);
        return next.region->search.contains(at) ? next.region->search.clearance(at) / next.distance_mm : 0;
    }

    const std::vector<DrawnRegion>& regions_;
    const DrawnRegion& own_;
    Vec3 up_;
    double depth_;
    std::vector<PlaneAhead> ahead_;
};

}  // namespace

std::vector<Bound> wall_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                               double sign) {
    const Walls walls(planes, regions, regions[region], sign);
    const double belief = walls.belief();
    return belief < kLeastBelief ? std::vector<Bound>{} : walls.bounds(belief);
}

}  // namespace kontur
