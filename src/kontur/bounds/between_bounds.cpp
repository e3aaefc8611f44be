// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/between_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/smooth_step.h"
#include "kontur/base/turn.h"

namespace kontur {
namespace {

// Of seven tubes the mean Dice is .964, of 30 drawings by few planes .874. kNearest: half costs the latter .0014, twice the
// former .038. kNoise: half or twice +-.001. kCone, kNearby: no tube, few planes at most .002.
constexpr double kCone = 0.7;    // cosine: of the way with both normals
constexpr double kNearest = 3;   // radii: nearer sections need no help
constexpr double kValue = 0.35;  // of the depth; half leaves .01 of a straight tube away, twice makes one too thick by .03
constexpr double kNoise = 0.2;
constexpr double kStraight = 0.9;  // cosine: a plane that the way crosses more obliquely does not tell its direction
constexpr double kNearby = 0.25;   // of the way: so near another plane knows
constexpr std::size_t kMostProbes = 40;

/// What one outline of a plane encloses.
struct Part {
    std::size_t region;
    Vec3 center;
    double radius_mm;
    std::vector<Probe> probes;
};

std::vector<Part> parts_of(const std::vector<DrawnRegion>& regions) {
    std::vector<Part> parts;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const std::vector<double> areas = areas_without_holes(regions[r].section);
        for (std::size_t o = 0; o < areas.size(); ++o) {
            Part part{r, {}, std::sqrt(areas[o] / M_PI), {}};
            Point2 sum{};
            for (const Probe& probe : regions[r].inside)
                if (probe.outline == o) {
                    part.probes.push_back(probe);
                    sum = {sum[0] + probe.at[0], sum[1] + probe.at[1]};
                }
            if (part.probes.empty()) continue;
            const auto count = static_cast<double>(part.probes.size());
            part.center = regions[r].section.plane.from_uv({sum[0] / count, sum[1] / count});
            parts.push_back(std::move(part));
        }
    }
    return parts;
}

class Tubes {
public:
    explicit Tubes(const std::vector<DrawnRegion>& regions) : regions_(regions), parts_(parts_of(regions)) {
        for (const double sign : {1.0, -1.0})
            for (std::size_t p = 0; p < parts_.size(); ++p) (sign > 0 ? above_ : below_).push_back(nearest(p, sign));
    }

    std::vector<Bound> find() const {
        std::vector<Bound> bounds;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            for (const double sign : {1.0, -1.0}) {
                const auto next = ahead(p, sign);
                if (!next || next->part < p) continue;  // once for both
                const double back = sign_towards(next->part, parts_[p].center);
                const auto before = ahead(next->part, back);
                if (!before || before->part != p) continue;
                if (const double belief = belief_in(p, sign, *next, back); belief > kLeastBelief)
                    append(parts_[p], parts_[next->part], belief, bounds);
            }
        return bounds;
    }

private:
    struct Ahead {
        std::size_t part;
        double away_mm;
    };

    const Vec3& normal(std::size_t part) const { return regions_[parts_[part].region].section.plane.normal; }

    double sign_towards(std::size_t part, const Vec3& place) const {
        return dot(place - parts_[part].center, normal(part)) < 0 ? -1 : 1;
    }

    const std::optional<Ahead>& ahead(std::size_t part, double sign) const { return (sign > 0 ? above_ : below_)[part]; }

    std::optional<Ahead> nearest(std::size_t own, double sign) const {
        std::optional<Ahead> found;
        for (std::size_t other = 0; other < parts_.size(); ++other) {
            if (parts_[other].region == parts_[own].region) continue;
            const Vec3 way = parts_[other].center - parts_[own].center;
            const double away = norm(way);
            if (found && away >= found->away_mm) continue;
            if (sign * dot(way, normal(own)) > kCone * away && std::abs(dot(way, normal(other))) > kCone * away)
                found = Ahead{other, away};
        }
        return found;
    }

    double belief_in(std::size_t part, double sign, const Ahead& next, double back) const {
        const double radius = std::max(parts_[part].radius_mm, parts_[next.part].radius_mm);
        if (next.away_mm < kNearest * radius) return 0;
        double belief = 1 - smooth_step(kFar, kTooFar, next.away_mm / radius);
        for (const auto& other : {ahead(part, -sign), ahead(next.part, -back)})
            if (other) belief *= 1 - smooth_step(kUneven, kTooUneven, next.away_mm / std::max(other->away_mm, 1e-300));
        return belief;
    }

    void append(const Part& from, const Part& to, double belief, std::vector<Bound>& bounds) const {
        const DrawnRegion &here = regions_[from.region], &there = regions_[to.region];
        const Vec3 way = to.center - from.center;
        const double length = norm(way);
        const auto along = [&](const Vec3& n) { return dot(n, way) < 0 ? -1.0 * n : n; };
        const Vec3 leaves = along(here.section.plane.normal), enters = along(there.section.plane.normal);
        const auto direction = [&](const Vec3& n) { return dot(n, way) > kStraight * length ? n : way / length; };
        // Half-way along the cubic with these tangents at its ends.
        const Vec3 middle = 0.5 * (from.center + to.center) + length / 8 * (direction(leaves) - direction(enters));
        const std::size_t stride = std::max<std::size_t>(1, from.probes.size() / kMostProbes);
        for (std::size_t i = 0; i < from.probes.size(); i += stride) {
            const Vec3 off = here.section.plane.from_uv(from.probes[i].at) - from.center;
            const Vec3 off_there = to.radius_mm / from.radius_mm * turned(off, leaves, enters);
            const Point2 at = there.section.plane.to_uv(to.center + off_there);
            if (!there.search.contains(at)) continue;
            const double depth = std::min(from.probes[i].depth, there.search.clearance(at));
            const Vec3 place = middle + 0.5 * (off + off_there);
            if (!others_show_nothing(from, to, place, length))
                bounds.push_back({.position = place,
                                  .least_mm = kValue * depth,
                                  .noise_mm = faded(kNoise * depth, belief),
                                  .by_side = true});
        }
    }

    bool others_show_nothing(const Part& from, const Part& to, const Vec3& place, double length) const {
        for (std::size_t r = 0; r < regions_.size(); ++r) {
            if (r == from.region || r == to.region) continue;
            const Plane& plane = regions_[r].section.plane;
            if (std::abs(plane.distance_to(place)) > kNearby * length) continue;
            const Point2 at = plane.to_uv(place);
            if (!regions_[r].search.contains(at) && regions_[r].search.clearance(at) < length) return true;
        }
        return false;
    }

    const std::vector<DrawnRegion>& regions_;
    std::vector<Part> parts_;
    std::vector<std::optional<Ahead>> above_, below_;
};

}  // namespace

std::vector<Bound> between_bounds(const std::vector<DrawnRegion>& regions) { return Tubes(regions).find(); }

}  // namespace kontur
