// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/tube_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"

namespace kontur {
namespace {

// Cosine, of the way with both normals: half and twice change no tube, few planes at most .002.
constexpr double kCone = 0.7;
// Radii: nearer sections need no help, nor tilted ones. For all sections an aorta loses .0095; 3 (for none), and an arch
// loses .033 at 3 radii, 81 organ drawings nothing.
constexpr double kTooNear = 2.8;
/// Cosine of the way with the mean of both normals: two planes that the way crosses more obliquely do not tell its
/// direction. Without, cylinders that lean by 30 and 40 degrees across parallel rings fall from .960 and .945 to .943 and
/// .918.
constexpr double kStraight = 0.9;

bool share_a_ring(const TubeWay& a, const TubeWay& b) {
    const auto is_same = [](const RegionPart& p, const RegionPart& q) {
        return p.region == q.region && distance(p.center, q.center) == 0;
    };
    return is_same(a.from, b.from) || is_same(a.from, b.to) || is_same(a.to, b.from) || is_same(a.to, b.to);
}

class Tubes {
public:
    explicit Tubes(const std::vector<DrawnRegion>& regions) : regions_(regions), parts_(region_parts(regions)) {
        for (const double sign : {1.0, -1.0})
            for (std::size_t p = 0; p < parts_.size(); ++p) (sign > 0 ? above_ : below_).push_back(nearest(p, sign));
    }

    std::vector<TubeWay> find() const {
        std::vector<TubeWay> ways;
        for (std::size_t p = 0; p < parts_.size(); ++p)
            for (const double sign : {1.0, -1.0}) {
                const auto next = ahead(p, sign);
                if (!next || next->part < p) continue;  // once for both
                const double back = sign_towards(next->part, parts_[p].center);
                const auto before = ahead(next->part, back);
                if (!before || before->part != p) continue;
                if (const double belief = belief_in(p, sign, *next, back); belief > kLeastBelief)
                    ways.push_back(way(parts_[p], parts_[next->part], belief));
            }
        for (TubeWay& one : ways)
            for (const TubeWay& other : ways)
                if (&one != &other && share_a_ring(one, other)) one.chain = std::max(one.chain, other.belief);
        return ways;
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
        const double radii = next.away_mm / radius;
        double belief = 1 - smooth_step(kFar, kTooFar, radii);
        if (radii < kNearest) belief *= crossing(normal(part), normal(next.part)) * smooth_step(kTooNear, kNearest, radii);
        for (const auto& other : {ahead(part, -sign), ahead(next.part, -back)})
            if (other) belief *= 1 - smooth_step(kUneven, kTooUneven, next.away_mm / std::max(other->away_mm, 1e-300));
        return belief;
    }

    TubeWay way(const RegionPart& from, const RegionPart& to, double belief) const {
        const Vec3 chord = to.center - from.center;
        const double length = norm(chord);
        const auto along = [&](const Vec3& n) { return dot(n, chord) < 0 ? -1.0 * n : n; };
        TubeWay way{from,
                    to,
                    along(regions_[from.region].section.plane.normal),
                    along(regions_[to.region].section.plane.normal),
                    length,
                    belief,
                    0,
                    {}};
        const bool is_told = dot(normalized(way.leaves + way.enters), chord) > kStraight * length;
        const Vec3 first = is_told ? length * way.leaves : chord, last = is_told ? length * way.enters : chord;
        for (std::size_t i = 0; i < way.places.size(); ++i) {
            const double t = static_cast<double>(i) / static_cast<double>(way.places.size() - 1), rest = 1 - t;
            way.places[i] = from.center + t * t * (3 - 2 * t) * chord + t * rest * (rest * first - t * last);
        }
        return way;
    }

    const std::vector<DrawnRegion>& regions_;
    std::vector<RegionPart> parts_;
    std::vector<std::optional<Ahead>> above_, below_;
};

}  // namespace

std::vector<RegionPart> region_parts(const std::vector<DrawnRegion>& regions) {
    std::vector<RegionPart> parts;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const std::vector<double> areas = areas_without_holes(regions[r].section);
        for (std::size_t o = 0; o < areas.size(); ++o) {
            RegionPart part{r, {}, std::sqrt(areas[o] / M_PI), {}};
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

double TubeWay::distance_mm(const Vec3& place) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < places.size(); ++i) {
        const Vec3 step = places[i] - places[i - 1], off = place - places[i - 1];
        const double along = std::clamp(dot(off, step) / std::max(dot(step, step), 1e-300), 0.0, 1.0);
        least = std::min(least, norm(off - along * step));
    }
    return least;
}

double TubeWay::hides(const Vec3& normal) const {
    return belief * chain * std::max(crossing(normal, leaves), crossing(normal, enters));
}

std::vector<TubeWay> tube_ways(const std::vector<DrawnRegion>& regions) { return Tubes(regions).find(); }

}  // namespace kontur
