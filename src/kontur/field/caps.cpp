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

// Cosines between normals: planes tilted by less than 6 degrees count as parallel, by less than 37 degrees as slanted. A
// slanted contour that crosses a plane leads on beyond it, but not in its normal's direction.
constexpr double kParallel = 0.995, kSlanted = 0.8;

/// One side of a section's plane, and what the contour set tells about it.
class Side {
public:
    Side(const ContourSet& set, const std::vector<Section>& sections, const Section& section,
         const std::vector<Probe>& inside, double sign, double tolerance)
        : section_(section), inside_(inside), sign_(sign), tolerance_(tolerance) {
        for (const Probe& probe : inside) deepest_ = std::max(deepest_, probe.depth);
        for (const Section& other : sections)
            if (&other != &section) consider(other);
        for (const Contour& contour : set.contours)
            if (!contour.closed)
                for (const Vec3& p : contour.points) leads_on_ = leads_on_ || ahead(p) > tolerance_;
        for (const SurfacePoint& p : set.surface) single_reach_ = std::max(single_reach_, ahead(p.position));
        for (const Vec3& p : set.interior) single_reach_ = std::max(single_reach_, ahead(p));
        leads_on_ = leads_on_ || slanted_reach_ > deepest_;
    }

    void append_caps(std::vector<Cap>& caps) const {
        if (leads_on_) return;
        if (next_) return append_towards_next(caps);
        if (slanted_reach_ < tolerance_) append_rounded_end(caps);
    }

    /// Whether no other contour says how the object goes on.
    bool is_last() const { return !leads_on_ && !next_ && deepest_ > 0; }

    /// How far the object may go on beyond a last section.
    double height() const {
        const double widest = std::isinf(previous_distance_) ? deepest_ : 1.5 * deepest_;
        return std::max(std::min(previous_distance_, widest), 1.25 * std::max(single_reach_, slanted_reach_));
    }

    /// The plane at this distance, with the section's outlines.
    Section shifted(double distance) const {
        Section result = section_;
        result.plane.origin += sign_ * distance * section_.plane.normal;
        return result;
    }

private:
    double ahead(const Vec3& p) const { return sign_ * section_.plane.distance_to(p); }

    void consider(const Section& other) {
        const double cosine = std::abs(dot(section_.plane.normal, other.plane.normal));
        const double distance = ahead(other.plane.origin);
        if (cosine < kSlanted) {
            leads_on_ = leads_on_ || reach_of(other) > tolerance_;
        } else if (cosine < kParallel) {
            slanted_reach_ = std::max(slanted_reach_, reach_of(other));
        } else if (distance > tolerance_) {
            if (!next_ || distance < next_distance_) {
                next_ = &other;
                next_distance_ = distance;
            }
        } else if (distance < -tolerance_) {
            previous_distance_ = std::min(previous_distance_, -distance);
        }
    }

    double reach_of(const Section& other) const {
        double reach = 0;
        for (const Polygon2& outline : other.outlines)
            for (const Point2& p : outline) reach = std::max(reach, ahead(other.plane.from_uv(p[0], p[1])));
        return reach;
    }

    Vec3 above(const Point2& p, double height) const {
        return section_.plane.from_uv(p[0], p[1]) + sign_ * height * section_.plane.normal;
    }

    void append_towards_next(std::vector<Cap>& caps) const {
        const SectionSearch next(*next_);
        for (const Probe& probe : inside_) {
            const Vec3 there = above(probe.at, next_distance_);
            const Point2 at = next_->plane.to_uv(there);
            if (next.contains(at)) continue;
            // Near the next outline the fit knows better; the depth here bounds how far the surface can have moved.
            const double clear = std::min(next.clearance(at), probe.depth);
            if (clear <= next_distance_ / 2) continue;
            const double below = std::min(clear, next_distance_) / 4;
            caps.push_back({there, -below, -below});
        }
    }

    void append_rounded_end(std::vector<Cap>& caps) const {
        if (deepest_ == 0) return;
        const double height = this->height();
        for (const Probe& probe : inside_) {
            const double rim = 1 - probe.depth / deepest_;
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
    const std::vector<Probe>& inside_;
    double sign_, tolerance_;
    double deepest_ = 0;  ///< radius of the largest circle in the section, about
    bool leads_on_ = false;
    double slanted_reach_ = 0;
    const Section* next_ = nullptr;
    double next_distance_ = 0;
    double previous_distance_ = std::numeric_limits<double>::infinity();
    double single_reach_ = 0;  ///< of single points
};

/// How far outside of its own contours those of other planes cross this one: so far it may have been drawn incompletely.
double missing_reach(const Section& section, const std::vector<Section>& sections) {
    double reach = 0;
    for (const Section& other : sections) {
        if (&other == &section) continue;
        for (const Polygon2& outline : other.outlines)
            for (std::size_t i = 0, before = outline.size() - 1; i < outline.size(); before = i++) {
                const Vec3 a = other.plane.from_uv(outline[before][0], outline[before][1]);
                const Vec3 b = other.plane.from_uv(outline[i][0], outline[i][1]);
                const double da = section.plane.distance_to(a), db = section.plane.distance_to(b);
                if ((da > 0) == (db > 0)) continue;
                const Point2 crossing = section.plane.to_uv(a + (da / (da - db)) * (b - a));
                if (!section.contains(crossing)) reach = std::max(reach, section.clearance(crossing));
            }
    }
    return reach;
}

bool has_open_contour(const ContourSet& set, const Plane& plane, double tolerance) {
    return std::any_of(set.contours.begin(), set.contours.end(),
                       [&](const Contour& c) { return !c.closed && coincide(c.plane, plane, tolerance); });
}

// Half the distance is a guess, which must not bend the surface near by: docs/decisions/0002-caps.md.
constexpr double kProbeTrust = 0.05;

/// A lattice of `step` over the section's plane, where it is farther than `clearance` outside of its contours.
void append_leak_probes(const Section& section, const Ball3& ball, double step, double clearance, int threads,
                        std::vector<Cap>& probes) {
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
                if (clear > clearance)
                    rows[static_cast<std::size_t>(begin)].push_back(
                        {.position = position, .most_mm = 0, .value_mm = -clear / 2, .trust = kProbeTrust});
            }
    });
    for (const std::vector<Cap>& row : rows) probes.insert(probes.end(), row.begin(), row.end());
}

/// Beside the cap of a last section at the cap's height, and over it at twice the height: its dome can be pierced between
/// its points.
void append_end_probes(const Side& side, const std::vector<Probe>& inside, const Ball3& ball, double step, int threads,
                       std::vector<Cap>& caps) {
    const double height = side.height();
    append_leak_probes(side.shifted(height), ball, step, step, threads, caps);
    const Plane over = side.shifted(2 * height).plane;
    for (const Probe& probe : inside) caps.push_back({over.from_uv(probe.at[0], probe.at[1]), 0, -height / 2});
}

}  // namespace

std::vector<Cap> find_caps(const ContourSet& set) {
    std::vector<Cap> caps;
    const double tolerance = 1.5e-3 * diameter_mm(set);
    const std::vector<Section> sections = sections_of(set, tolerance);
    for (const Section& section : sections) {
        const std::vector<Probe> inside = probes(section);
        for (const double sign : {-1.0, 1.0}) Side(set, sections, section, inside, sign, tolerance).append_caps(caps);
    }
    return caps;
}

std::vector<Cap> find_leak_probes(const ContourSet& set, int threads) {
    std::vector<Cap> probes;
    const Ball3 around = smallest_ball(set);
    const Ball3 reached{around.center, 2 * around.radius};
    const double diameter = around.diameter(), tolerance = 1.5e-3 * diameter, step = diameter / 16;
    const std::vector<Section> sections = sections_of(set, tolerance);
    for (const Section& section : sections) {
        if (!has_open_contour(set, section.plane, tolerance)) {
            const double missing = missing_reach(section, sections);
            append_leak_probes(section, reached, step, std::max(step, 2 * missing), threads, probes);
        }
        const std::vector<Probe> inside = kontur::probes(section);
        for (const double sign : {-1.0, 1.0}) {
            const Side side(set, sections, section, inside, sign, tolerance);
            if (side.is_last()) append_end_probes(side, inside, reached, step, threads, probes);
        }
    }
    return probes;
}

}  // namespace kontur
