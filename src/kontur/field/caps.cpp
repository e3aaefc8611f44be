// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/caps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/field/section_probes.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

// Cosine between normals: planes tilted by less than 37 degrees count as slanted. A slanted contour that crosses a plane
// leads on beyond it, but not in its normal's direction.
constexpr double kSlanted = 0.8;

// A plane may show only some of the parts of an object. Where another one shows the object at less than this fraction of the
// distance from the lines of the first, that decides.
constexpr double kNearer = 0.25;

/// The regions drawn in all planes, for questions about any point.
class DrawnRegions {
public:
    explicit DrawnRegions(const std::vector<Section>& sections) {
        for (const Section& section : sections) {
            double radius = 0;
            for (const Polygon2& outline : section.outlines)
                for (const Point2& p : outline) radius = std::max(radius, std::hypot(p[0], p[1]));
            regions_.push_back({section.plane, SectionSearch(section), radius});
        }
    }

    /// Whether p lies over or under a region, nearer to it than `reach`, and its foot there fulfils the condition.
    template <class Condition>
    bool any_near(const Vec3& p, double reach, const Condition& holds) const {
        return std::any_of(regions_.begin(), regions_.end(), [&](const Region& region) {
            const double height = region.plane.distance_to(p);
            return std::abs(height) < reach && region.contains(p) && holds(p - height * region.plane.normal);
        });
    }

    /// A plane parallel to a section, on one side of it.
    struct Parallel {
        double distance;
        const Plane* plane;
        const SectionSearch* search;
        std::vector<bool> shows;  ///< for each outline of the section, whether it shows a probe in that
    };

    /// Those farther than `tolerance` in the direction of the section's normal times `sign`, the nearest first.
    std::vector<Parallel> parallel_to(const Section& section, const std::vector<Probe>& inside, double sign,
                                      double tolerance) const {
        std::vector<Parallel> found;
        for (const Region& region : regions_) {
            const double distance = sign * section.plane.distance_to(region.plane.origin);
            if (distance <= tolerance || !are_parallel(section.plane, region.plane)) continue;
            Parallel& parallel = found.emplace_back(
                Parallel{distance, &region.plane, &region.search, std::vector<bool>(section.outlines.size())});
            for (const Probe& probe : inside)
                if (!parallel.shows[probe.outline] && region.contains(section.plane.from_uv(probe.at)))
                    parallel.shows[probe.outline] = true;
        }
        std::sort(found.begin(), found.end(), [](const Parallel& a, const Parallel& b) { return a.distance < b.distance; });
        return found;
    }

private:
    struct Region {
        const Plane& plane;
        SectionSearch search;
        double radius;  ///< around the plane's origin

        /// Whether the foot of p lies in it.
        bool contains(const Vec3& p) const {
            const Point2 at = plane.to_uv(p);
            return std::hypot(at[0], at[1]) <= radius && search.contains(at);
        }
    };
    std::vector<Region> regions_;
};

/// How far a section lies from the one before it, rather one that shows a part of the object that it shows itself. One very
/// near to it, compared with the next one or, without any, with the section's inscribed radius, shows the same place once
/// more and does not count.
std::optional<double> distance_to_previous(const std::vector<DrawnRegions::Parallel>& behind, double radius) {
    constexpr double kSamePlace = 0.125;
    constexpr double kSameAlone = 0.02;  // 1 % of the width: neighbouring slices of a wide organ are hardly farther apart
    std::vector<double> same_part, all;
    for (const DrawnRegions::Parallel& plane : behind) {
        all.push_back(plane.distance);
        if (std::find(plane.shows.begin(), plane.shows.end(), true) != plane.shows.end())
            same_part.push_back(plane.distance);
    }
    const std::vector<double>& distances = same_part.empty() ? all : same_part;
    if (distances.empty()) return std::nullopt;
    if (distances.size() == 1) return distances[0] < kSameAlone * radius ? std::nullopt : std::optional(distances[0]);
    return distances[distances[0] < kSamePlace * (distances[1] - distances[0]) ? 1 : 0];
}

/// One side of a section's plane, and what the contour set tells about it.
class Side {
public:
    using Parallels = std::vector<DrawnRegions::Parallel>;

    /// `section` is one of the planes', `inside` are its probes, `planes_ahead` and `planes_behind` those parallel to it;
    /// all must outlive the side.
    Side(const DrawnPlanes& planes, const Section& section, const std::vector<Probe>& inside, double sign,
         const Parallels& planes_ahead, const Parallels& planes_behind)
        : section_(section),
          inside_(inside),
          sign_(sign),
          tolerance_(planes.tolerance_mm),
          deepest_(deepest(inside)),
          ahead_(planes_ahead),
          previous_mm_(distance_to_previous(planes_behind, deepest_)) {
        for (const Section& other : planes.sections)
            if (!are_parallel(section.plane, other.plane)) consider(other);
        for (const Contour& contour : planes.set.contours)
            if (!contour.closed)
                for (const Vec3& p : contour.points) leads_on_ = leads_on_ || ahead(p) > tolerance_;
        for (const SurfacePoint& p : planes.set.surface) single_reach_ = std::max(single_reach_, ahead(p.position));
        for (const Vec3& p : planes.set.interior) single_reach_ = std::max(single_reach_, ahead(p));
        leads_on_ = leads_on_ || slanted_reach_ > deepest_;
    }

    void append_caps(std::vector<Cap>& caps) const {
        if (leads_on_) return;
        if (!ahead_.empty()) return append_towards_next(caps);
        if (slanted_reach_ < tolerance_) append_rounded_end(caps);
    }

    /// Whether no other contour says how the object goes on.
    bool is_last() const { return !leads_on_ && ahead_.empty(); }

    /// Whether contours of other directions alone say where the object ends.
    bool is_left_to_others() const { return leads_on_ && ahead_.empty(); }

    /// Whether nothing that was drawn tells how thick the object is here.
    bool is_guess() const { return is_last() && !previous_mm_ && !crossed_; }

    /// How far the object may go on beyond a last section.
    double height() const {
        const double own = previous_mm_ ? std::min(*previous_mm_, 1.5 * deepest_) : deepest_;
        return std::max(own, 1.25 * std::max(single_reach_, slanted_reach_));
    }

    /// The plane at this distance, with the section's outlines.
    Section shifted(double distance) const {
        Section result = section_;
        result.plane.origin += sign_ * distance * section_.plane.normal;
        return result;
    }

    /// How far a place lies beyond the section.
    double ahead(const Vec3& p) const { return sign_ * section_.plane.distance_to(p); }

private:
    void consider(const Section& other) {
        crossed_ = true;
        const double reach = reach_of(other);
        if (std::abs(dot(section_.plane.normal, other.plane.normal)) < kSlanted) leads_on_ = leads_on_ || reach > tolerance_;
        else slanted_reach_ = std::max(slanted_reach_, reach);
    }

    double reach_of(const Section& other) const {
        double reach = 0;
        for (const Polygon2& outline : other.outlines)
            for (const Point2& p : outline) reach = std::max(reach, ahead(other.plane.from_uv(p)));
        return reach;
    }

    Vec3 above(const Point2& p, double height) const {
        return section_.plane.from_uv(p) + sign_ * height * section_.plane.normal;
    }

    Point2 foot(const Probe& probe, const DrawnRegions::Parallel& plane) const {
        return plane.plane->to_uv(above(probe.at, plane.distance));
    }

    /// The plane ahead that tells where the object goes on from a probe: the next one, unless it shows nothing of this part
    /// of the object, and one beyond it shows it nearer to this place than the next one's lines are.
    const DrawnRegions::Parallel& deciding(const Probe& probe) const {
        const DrawnRegions::Parallel& next = ahead_.front();
        if (next.shows[probe.outline]) return next;
        const double beside = next.search->clearance(foot(probe, next));
        const auto found = std::find_if(ahead_.begin() + 1, ahead_.end(), [&](const DrawnRegions::Parallel& beyond) {
            return beyond.shows[probe.outline] && beyond.distance - next.distance < beside / 2;
        });
        return found == ahead_.end() ? next : *found;
    }

    void append_towards_next(std::vector<Cap>& caps) const {
        for (const Probe& probe : inside_) {
            const DrawnRegions::Parallel& plane = deciding(probe);
            const Point2 at = foot(probe, plane);
            if (plane.search->contains(at)) continue;
            // Near the next outline the fit knows better; the depth here bounds how far the surface can have moved.
            const double clear = std::min(plane.search->clearance(at), probe.depth);
            if (clear <= plane.distance / 2) continue;
            const double below = std::min(clear, plane.distance) / 4;
            caps.push_back({above(probe.at, plane.distance), -below, -below});
        }
    }

    void append_rounded_end(std::vector<Cap>& caps) const {
        if (deepest_ == 0) return;
        const double height = this->height();
        for (const Probe& probe : inside_) append_dome(probe.at, probe.depth, caps);
        if (is_flat()) append_flat_rim(caps);
        // The outline itself must not be carried on, neither straight nor flaring.
        for (const Polygon2& outline : section_.outlines) {
            for (std::size_t i = 0; i < outline.size(); i += stride_along(outline))
                caps.push_back({above(outline[i], height), -height / 4, -height / 4});
        }
    }

    bool is_flat() const { return height() < deepest_ / 4; }

    /// The end above a place in the section with this distance from the outlines.
    void append_dome(const Point2& at, double depth, std::vector<Cap>& caps) const {
        const double rim = 1 - std::min(depth / deepest_, 1.0), dome = height() * std::sqrt(1 - rim * rim);
        caps.push_back({above(at, dome), 0, 0});
        // So many zeros over a flat body would make f vanish within it, too, and open holes far from the lines.
        if (is_flat())
            caps.push_back({.position = section_.plane.from_uv(at),
                            .most_mm = std::numeric_limits<double>::infinity(),
                            .value_mm = dome / 2,
                            .least_mm = dome / 8,
                            .kind = ConstraintKind::interior});
    }

    /// Between the outlines and the probes next to them, which are far apart compared with the height of a flat end: where f
    /// rises from the wall as steeply as everywhere, it would make a lip and a groove behind it.
    void append_flat_rim(std::vector<Cap>& caps) const {
        const SectionSearch search(section_);
        for (const Polygon2& outline : section_.outlines)
            for (std::size_t i = 0; i < outline.size(); i += stride_along(outline)) {
                const Point2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
                const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
                if (length == 0) continue;
                const Point2 left{(a[1] - b[1]) / length, (b[0] - a[0]) / length};
                double inset = height();
                while (inset < deepest_ / 6) {
                    for (const double side : {-inset, inset}) {
                        const Point2 at{(a[0] + b[0]) / 2 + side * left[0], (a[1] + b[1]) / 2 + side * left[1]};
                        if (!search.contains(at)) continue;
                        if (const double depth = search.clearance(at); depth > 0.9 * inset) append_dome(at, depth, caps);
                    }
                    inset *= 2;
                }
            }
    }

    /// Every how many points of an outline there are caps.
    static std::size_t stride_along(const Polygon2& outline) { return std::max<std::size_t>(1, outline.size() / 40); }

    const Section& section_;
    const std::vector<Probe>& inside_;
    double sign_, tolerance_, deepest_;
    const Parallels& ahead_;
    std::optional<double> previous_mm_;
    bool leads_on_ = false;
    bool crossed_ = false;  ///< there are contours of other directions
    double slanted_reach_ = 0;
    double single_reach_ = 0;  ///< of single points
};

/// How far outside of its own contours those of other planes cross this one: so far it may have been drawn incompletely.
double missing_reach(const Section& section, const std::vector<Section>& sections) {
    const SectionSearch search(section);
    double reach = 0;
    for (const Section& other : sections) {
        if (&other == &section) continue;
        for (const Polygon2& outline : other.outlines)
            for_each_edge(outline, [&](const Point2& from, const Point2& to) {
                const Vec3 a = other.plane.from_uv(from), b = other.plane.from_uv(to);
                const double da = section.plane.distance_to(a), db = section.plane.distance_to(b);
                if ((da > 0) == (db > 0)) return;
                const Point2 crossing = section.plane.to_uv(a + (da / (da - db)) * (b - a));
                if (!search.contains(crossing)) reach = std::max(reach, search.clearance(crossing));
            });
    }
    return reach;
}

bool has_open_contour(const DrawnPlanes& planes, const Plane& plane) {
    return std::any_of(planes.set.contours.begin(), planes.set.contours.end(),
                       [&](const Contour& c) { return !c.closed && lies_in(c, plane, planes.tolerance_mm); });
}

/// Spreads leak probes over planes, on lattices of the same step and within the same ball.
class LeakProbes {
public:
    LeakProbes(const DrawnRegions& regions, const Ball3& around, int threads)
        : regions_(regions), ball_{around.center, 2 * around.radius}, step_(ball_.radius / kSteps), threads_(threads) {}

    /// Outside of the section's contours, farther than a step and than twice the reach of what may be missing, and not where
    /// another plane shows the object nearer by.
    void append_beside(const Section& section, double missing_reach, std::vector<Cap>& probes) const {
        const double least = std::max(step_, 2 * missing_reach);
        const SectionAxes axes(section);
        const SectionSearch search(section);
        const Point2 center = axes.from_plane(section.plane.to_uv(ball_.center));
        std::array<std::vector<Cap>, 2 * kSteps + 1> rows;
        parallel_for(2 * kSteps + 1, 4, threads_, [&](std::int64_t begin, std::int64_t end) {
            for (; begin < end; ++begin)
                for (int i = -kSteps; i <= kSteps; ++i) {
                    const Point2 at =
                        axes.to_plane({center[0] + i * step_, center[1] + static_cast<double>(begin - kSteps) * step_});
                    const Vec3 position = section.plane.from_uv(at);
                    if (distance(position, ball_.center) > ball_.radius || search.contains(at)) continue;
                    const double clear = search.clearance(at);
                    if (clear > least && !shown_by_others(position, section.plane.normal, clear))
                        rows[static_cast<std::size_t>(begin)].push_back(
                            {.position = position, .most_mm = 0, .value_mm = -clear / 2, .trust = kTrust});
                }
        });
        for (const std::vector<Cap>& row : rows) probes.insert(probes.end(), row.begin(), row.end());
    }

    /// Beside the cap of a last section at the cap's height, and over it at twice the height, where its dome can be pierced
    /// between its points; and farther beyond.
    void append_beyond(const Side& side, const std::vector<Probe>& inside, std::vector<Cap>& probes) const {
        const double height = side.height();
        if (height == 0) return;  // a hole in nothing ends nothing
        append_beside(side.shifted(height), 0, probes);
        const Plane over = side.shifted(2 * height).plane;
        for (const Probe& probe : inside) probes.push_back({over.from_uv(probe.at), 0, -height / 2});
        double far = 0.98 * (ball_.radius + side.ahead(ball_.center));
        while (far > 2.5 * height) {
            append_far_beyond(side.shifted(far), far - height, probes);
            far /= 1.5;
        }
    }

    /// All around the drawing, where nothing that was drawn can lead. Of planes that contradict each other, each counts on
    /// the others to end the object, and leak probes beside their contours keep away from what may be missing.
    void append_around(std::vector<Cap>& probes) const {
        constexpr int kPlaces = 128;
        const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
        for (int i = 0; i < kPlaces; ++i) {
            const double z = (2 * i + 1.0) / kPlaces - 1, angle = i * golden_angle, r = std::sqrt(1 - z * z);
            const Vec3 direction{r * std::cos(angle), r * std::sin(angle), z};
            probes.push_back({.position = ball_.center + ball_.radius * direction,
                              .most_mm = 0,
                              .value_mm = -ball_.radius / 4,
                              .trust = kTrust,
                              .far = true});
        }
    }

private:
    /// All over a plane at a distance from the end of the object. However low f is behind the cap, it can rise again in a
    /// cone that widens with the distance, and voxels thicker than the gap between them join the two. Of what widens, few
    /// points on a coarse lattice are enough.
    void append_far_beyond(const Section& end, double beyond, std::vector<Cap>& probes) const {
        constexpr int kFarSteps = 6;
        const double step = ball_.radius / kFarSteps;
        const SectionAxes axes(end);
        const SectionSearch search(end);
        const Point2 center = axes.from_plane(end.plane.to_uv(ball_.center));
        for (int j = -kFarSteps; j <= kFarSteps; ++j)
            for (int i = -kFarSteps; i <= kFarSteps; ++i) {
                const Point2 at = axes.to_plane({center[0] + i * step, center[1] + j * step});
                const Vec3 position = end.plane.from_uv(at);
                if (distance(position, ball_.center) > ball_.radius) continue;
                const double clear = std::hypot(beyond, search.contains(at) ? 0.0 : search.clearance(at));
                probes.push_back({.position = position, .most_mm = 0, .value_mm = -clear / 2, .trust = kTrust, .far = true});
            }
    }

    /// Whether another plane near by shows the object at a place, or planes on both sides of it do.
    bool shown_by_others(const Vec3& p, const Vec3& normal, double clear) const {
        return regions_.any_near(p, kNearer * clear, [](const Vec3&) { return true; }) ||
               (regions_.any_near(p, clear, [&](const Vec3& foot) { return dot(foot - p, normal) > 0; }) &&
                regions_.any_near(p, clear, [&](const Vec3& foot) { return dot(foot - p, normal) < 0; }));
    }

    static constexpr int kSteps = 16;  ///< from the ball's center to its surface
    // Half the distance is a guess, which must not bend the surface near by: docs/decisions/0002-caps.md.
    static constexpr double kTrust = 0.05;

    const DrawnRegions& regions_;
    Ball3 ball_;
    double step_;
    int threads_;
};

}  // namespace

Limits find_limits(const DrawnPlanes& planes, int threads) {
    Limits limits;
    const DrawnRegions regions(planes.sections);
    const LeakProbes leak_probes(regions, planes.ball, threads);
    bool is_left_to_others = false;
    for (const Section& section : planes.sections) {
        if (!has_open_contour(planes, section.plane))
            leak_probes.append_beside(section, missing_reach(section, planes.sections), limits.leak_probes);
        const std::vector<Probe> inside = probes(section);
        const auto below = regions.parallel_to(section, inside, -1, planes.tolerance_mm);
        const auto above = regions.parallel_to(section, inside, 1, planes.tolerance_mm);
        for (const double sign : {-1.0, 1.0}) {
            const Side side(planes, section, inside, sign, sign > 0 ? above : below, sign > 0 ? below : above);
            side.append_caps(limits.caps);
            is_left_to_others = is_left_to_others || side.is_left_to_others();
            if (side.is_last()) leak_probes.append_beyond(side, inside, limits.leak_probes);
            if (side.is_guess() && limits.notes.empty())
                limits.notes.push_back(
                    fmt::format("contour {} has no others beside it but in nearly the same plane; the thickness of the "
                                "object there is a guess from its width",
                                section.contours.front() + 1));
        }
    }
    if (is_left_to_others) leak_probes.append_around(limits.leak_probes);
    return limits;
}

}  // namespace kontur
