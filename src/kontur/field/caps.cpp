// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kontur/base/parallel.h"
#include "kontur/field/section_probes.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

constexpr double kParallel = 0.995;  // cosine between normals: planes tilted by less than 6 degrees count as parallel

/// One side of a section's plane.
class Side {
public:
    Side(const std::vector<Section>& sections, const Section& section, double sign, double tolerance)
        : section_(section), sign_(sign), tolerance_(tolerance) {
        for (const Section& other : sections)
            if (&other != &section_) consider(other);
    }

    /// What else was drawn on this side: open contours lead on, single points say how far the object reaches at least.
    void consider_rest(const ContourSet& set) {
        const auto ahead = [&](const Vec3& p) { return sign_ * section_.plane.distance_to(p); };
        for (const Contour& contour : set.contours)
            if (!contour.closed)
                for (const Vec3& p : contour.points) leads_on_ = leads_on_ || ahead(p) > tolerance_;
        for (const SurfacePoint& p : set.surface) reach_ = std::max(reach_, ahead(p.position));
        for (const Vec3& p : set.interior) reach_ = std::max(reach_, ahead(p));
    }

    void append_caps(const std::vector<Probe>& inside, std::vector<Cap>& caps) const {
        if (leads_on_) return;
        if (next_) return append_towards_next(inside, caps);
        append_rounded_end(inside, caps);
    }

    /// Whether no other contour says how the object goes on.
    bool is_last() const { return !leads_on_ && !next_; }

    /// How far the object may go on beyond a last section.
    double height(const std::vector<Probe>& inside) const {
        const double deepest = deepest_of(inside);
        const double widest = std::isinf(previous_distance_) ? deepest : 1.5 * deepest;
        return std::max(std::min(previous_distance_, widest), 1.25 * reach_);
    }

private:
    void consider(const Section& other) {
        const double ahead = sign_ * section_.plane.distance_to(other.plane.origin);
        if (std::abs(dot(section_.plane.normal, other.plane.normal)) < kParallel) {
            leads_on_ = leads_on_ || reaches_beyond(other);
        } else if (ahead > tolerance_) {
            if (!next_ || ahead < next_distance_) {
                next_ = &other;
                next_distance_ = ahead;
            }
        } else if (ahead < -tolerance_) {
            previous_distance_ = std::min(previous_distance_, -ahead);
        }
    }

    bool reaches_beyond(const Section& other) const {
        for (const Polygon2& outline : other.outlines)
            for (const Point2& p : outline)
                if (sign_ * section_.plane.distance_to(other.plane.from_uv(p[0], p[1])) > tolerance_) return true;
        return false;
    }

    static double deepest_of(const std::vector<Probe>& inside) {
        double deepest = 0;
        for (const Probe& probe : inside) deepest = std::max(deepest, probe.depth);
        return deepest;
    }

    Vec3 above(const Point2& p, double height) const {
        return section_.plane.from_uv(p[0], p[1]) + sign_ * height * section_.plane.normal;
    }

    void append_towards_next(const std::vector<Probe>& inside, std::vector<Cap>& caps) const {
        const SectionSearch next(*next_);
        for (const Probe& probe : inside) {
            const Vec3 there = above(probe.at, next_distance_);
            const Point2 at = next_->plane.to_uv(there);
            if (next.contains(at)) continue;
            // Near the next outline the fit knows better; the depth here bounds how far the surface can have moved.
            const double clear = std::min(next.clearance(at), probe.depth);
            if (clear > next_distance_ / 2) caps.push_back({there, -clear / 4, -clear / 4});
        }
    }

    void append_rounded_end(const std::vector<Probe>& inside, std::vector<Cap>& caps) const {
        const double deepest = deepest_of(inside), height = this->height(inside);
        if (deepest == 0) return;
        for (const Probe& probe : inside) {
            const double rim = 1 - probe.depth / deepest;
            caps.push_back({above(probe.at, height * std::sqrt(1 - rim * rim)), 0, 0});
        }
        // The outline itself must not be carried on, neither straight nor flaring.
        for (const Polygon2& outline : section_.outlines) {
            const std::size_t stride = std::max<std::size_t>(1, outline.size() / 40);
            for (std::size_t i = 0; i < outline.size(); i += stride)
                caps.push_back({above(outline[i], height), -height / 4, -height / 4});
        }
    }

    const Section& section_;
    double sign_, tolerance_;
    bool leads_on_ = false;
    const Section* next_ = nullptr;
    double next_distance_ = 0;
    double previous_distance_ = std::numeric_limits<double>::infinity();
    double reach_ = 0;
};

/// Whether contours of other planes cross this one farther than `tolerance` outside of its own contours.
bool is_incomplete(const Section& section, const std::vector<Section>& sections, double tolerance) {
    for (const Section& other : sections) {
        if (&other == &section) continue;
        for (const Polygon2& outline : other.outlines)
            for (std::size_t i = 0, before = outline.size() - 1; i < outline.size(); before = i++) {
                const Vec3 a = other.plane.from_uv(outline[before][0], outline[before][1]);
                const Vec3 b = other.plane.from_uv(outline[i][0], outline[i][1]);
                const double da = section.plane.distance_to(a), db = section.plane.distance_to(b);
                if ((da > 0) == (db > 0)) continue;
                const Point2 crossing = section.plane.to_uv(a + (da / (da - db)) * (b - a));
                if (!section.contains(crossing) && section.clearance(crossing) > tolerance) return true;
            }
    }
    return false;
}

bool has_open_contour(const ContourSet& set, const Plane& plane, double tolerance) {
    return std::any_of(set.contours.begin(), set.contours.end(),
                       [&](const Contour& c) { return !c.closed && coincide(c.plane, plane, tolerance); });
}

// Half the distance is a guess, which must not bend the surface near by: docs/decisions/0002-caps.md.
constexpr double kProbeTrust = 0.05;

void append_leak_probes(const Section& section, const Ball3& ball, double step, int threads, std::vector<Cap>& probes) {
    const SectionAxes axes(section);
    const SectionSearch search(section);
    const Point2 center = axes.from_plane(section.plane.to_uv(ball.center));
    const int reach = static_cast<int>(std::ceil(ball.radius / step));
    std::vector<std::vector<Cap>> rows(static_cast<std::size_t>(2 * reach + 1));
    parallel_for(2 * reach + 1, 4, threads, [&](std::int64_t begin, std::int64_t end) {
        for (; begin < end; ++begin)
            for (int i = -reach; i <= reach; ++i) {
                const Point2 at =
                    axes.to_plane({center[0] + i * step, center[1] + static_cast<double>(begin - reach) * step});
                const Vec3 position = section.plane.from_uv(at[0], at[1]);
                if (distance(position, ball.center) > ball.radius || search.contains(at)) continue;
                const double clear = search.clearance(at);
                if (clear > step)
                    rows[static_cast<std::size_t>(begin)].push_back(
                        {.position = position, .most_mm = 0, .value_mm = -clear / 2, .trust = kProbeTrust});
            }
    });
    for (const std::vector<Cap>& row : rows) probes.insert(probes.end(), row.begin(), row.end());
}

/// Beside the cap of a last section at the cap's height, and over it at twice the height: its dome can be pierced between
/// its points.
void append_end_probes(const Section& section, double sign, const Side& side, const Ball3& ball, double step, int threads,
                       std::vector<Cap>& caps) {
    const std::vector<Probe> inside = probes(section);
    if (inside.empty()) return;
    const double height = side.height(inside);
    Section end = section;
    end.plane.origin += sign * height * section.plane.normal;
    append_leak_probes(end, ball, step, threads, caps);
    end.plane.origin += sign * height * section.plane.normal;
    for (const Probe& probe : inside) caps.push_back({end.plane.from_uv(probe.at[0], probe.at[1]), 0, -height / 2});
}

}  // namespace

std::vector<Cap> find_caps(const ContourSet& set) {
    std::vector<Cap> caps;
    const double tolerance = 1.5e-3 * diameter_mm(set);
    const std::vector<Section> sections = sections_of(set, tolerance);
    for (const Section& section : sections) {
        const std::vector<Probe> inside = probes(section);
        for (const double sign : {-1.0, 1.0}) {
            Side side(sections, section, sign, tolerance);
            side.consider_rest(set);
            side.append_caps(inside, caps);
        }
    }
    return caps;
}

std::vector<Cap> find_leak_probes(const ContourSet& set, int threads) {
    std::vector<Cap> probes;
    const Ball3 around = smallest_ball(set);
    const Ball3 reached{around.center, 2 * around.radius};
    const double diameter = around.diameter(), tolerance = 1.5e-3 * diameter;
    const std::vector<Section> sections = sections_of(set, tolerance);
    for (const Section& section : sections) {
        if (!has_open_contour(set, section.plane, tolerance) && !is_incomplete(section, sections, 0.075 * diameter))
            append_leak_probes(section, reached, diameter / 16, threads, probes);
        for (const double sign : {-1.0, 1.0}) {
            Side side(sections, section, sign, tolerance);
            side.consider_rest(set);
            if (side.is_last()) append_end_probes(section, sign, side, reached, diameter / 16, threads, probes);
        }
    }
    return probes;
}

}  // namespace kontur
