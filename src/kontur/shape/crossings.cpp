// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/crossings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

constexpr double kLeastSine = 0.0087;  // half a degree: off-plane errors grow by its inverse along the common line

/// A section with what the search needs of it.
struct BoxedSection {
    Section section;
    Box3 box;
};

/// A section that is asked for the place nearest to every passage of others through its plane.
struct SearchableSection {
    const Section& section;
    SectionSearch search;
};

std::vector<BoxedSection> drawn_planes(const ContourSet& set) {
    std::vector<BoxedSection> planes;
    for (const Section& section : sections_of(set, kSamePlane * diameter_mm(set))) {
        BoxedSection boxed{{section.plane, {}, {}, {}}, {}};
        for (std::size_t o = 0; o < section.outlines.size(); ++o) {
            const Contour& contour = set.contours[section.contours[o]];
            if (!contour.closed || contour.points.size() < 3) continue;
            boxed.section.outlines.push_back(section.outlines[o]);
            boxed.section.contours.push_back(section.contours[o]);
            for (const Vec3& p : contour.points) boxed.box.extend(p);
        }
        if (!boxed.section.outlines.empty()) planes.push_back(std::move(boxed));
    }
    return planes;
}

struct SpanLine {
    Vec3 origin, direction;
    double sine;  ///< of the angle between the planes

    double along(const Vec3& p) const { return dot(direction, p - origin); }
};

std::optional<SpanLine> common_line(const Plane& a, const Plane& b, const Vec3& near) {
    const Vec3 direction = cross(a.normal, b.normal);
    const double sine = norm(direction);
    if (sine < kLeastSine) return std::nullopt;
    const double da = a.distance_to(near), db = b.distance_to(near), cosine = dot(a.normal, b.normal);
    const double wa = (da - cosine * db) / (sine * sine), wb = (db - cosine * da) / (sine * sine);
    return SpanLine{near - wa * a.normal - wb * b.normal, direction / sine, sine};
}

/// Where an outline of a section passes through another plane.
struct Passage {
    double at;  ///< mm along the common line
    Point2 position;
    std::size_t outline, edge;
};

/// Signed distance from a plane, of points given in another plane's own coordinates.
struct Distance {
    double constant, du, dv;

    Distance(const Plane& own, const Plane& other)
        : constant(other.distance_to(own.origin)), du(dot(other.normal, own.u)), dv(dot(other.normal, own.v)) {}
    double operator()(const Point2& p) const { return constant + du * p[0] + dv * p[1]; }
};

/// All of one section's passages in order along the line: the object begins at the first, ends at the second, and so on.
std::vector<Passage> passages(const Section& section, const Plane& other, const SpanLine& line) {
    const Distance distance(section.plane, other);
    std::vector<Passage> result;
    for (std::size_t o = 0; o < section.outlines.size(); ++o) {
        const Polygon2& outline = section.outlines[o];
        double before = distance(outline.back());
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const double here = distance(outline[i]);
            if ((before >= 0) != (here >= 0)) {
                const std::size_t edge = i > 0 ? i - 1 : outline.size() - 1;
                const Point2 &a = outline[edge], &b = outline[i];
                const double t = before / (before - here);
                const Point2 p{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
                result.push_back({line.along(section.plane.from_uv(p)), p, o, edge});
            }
            before = here;
        }
    }
    std::sort(result.begin(), result.end(), [](const Passage& a, const Passage& b) { return a.at < b.at; });
    return result;
}

bool reaches(const Box3& box, const Plane& plane) {
    const Vec3 half = 0.5 * box.size();
    const double reach =
        half.x * std::abs(plane.normal.x) + half.y * std::abs(plane.normal.y) + half.z * std::abs(plane.normal.z);
    return std::abs(plane.distance_to(box.center())) <= reach * (1 + 1e-9);
}

/// How far the part of an outline between two passages reaches beyond the other plane, in mm within its own plane; of the
/// two parts the lesser.
double depth_between(const Section& section, const Plane& other, const SpanLine& line, const Passage& a, const Passage& b) {
    if (a.outline != b.outline) return std::numeric_limits<double>::infinity();
    const Distance distance(section.plane, other);
    const Polygon2& outline = section.outlines[a.outline];
    const auto [first, last] = std::minmax(a.edge, b.edge);
    double between = 0, beyond = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        double& depth = i > first && i <= last ? between : beyond;
        depth = std::max(depth, std::abs(distance(outline[i])));
    }
    return std::min(between, beyond) / line.sine;
}

/// Two planes whose contours meet on a line.
class PlanePair {
public:
    PlanePair(const SearchableSection& a, const SearchableSection& b, const SpanLine& line)
        : sections_{&a.section, &b.section}, searches_{&a.search, &b.search}, line_(line) {}

    /// In order along the line the passages of both planes form pairs: between the two of a pair the planes contradict each
    /// other, outside of the pairs they agree. Two passages of one plane have no match in the other.
    void append_to(std::vector<Crossing>& crossings) const {
        std::vector<Sighting> all = sightings(0);
        const std::vector<Sighting> of_b = sightings(1);
        all.insert(all.end(), of_b.begin(), of_b.end());
        std::stable_sort(all.begin(), all.end(),
                         [](const Sighting& p, const Sighting& q) { return p.passage.at < q.passage.at; });
        for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
            const Sighting &p = all[i], &q = all[i + 1];
            if (p.plane != q.plane) crossings.push_back(matched(p, q));
            else append_unmatched(p, q, crossings);
        }
    }

private:
    struct Sighting {
        int plane;
        bool begins;  ///< the object, in the direction of the line
        Passage passage;
    };

    std::vector<Sighting> sightings(int plane) const {
        std::vector<Sighting> result;
        for (const Passage& passage : passages(*sections_[plane], sections_[1 - plane]->plane, line_))
            result.push_back({plane, result.size() % 2 == 0, passage});
        return result;
    }

    std::size_t contour(const Sighting& s) const { return sections_[s.plane]->contours[s.passage.outline]; }
    Vec3 position(const Sighting& s) const { return sections_[s.plane]->plane.from_uv(s.passage.position); }
    /// In the plane that `s` does not belong to.
    Section::Nearest nearest_other(const Sighting& s) const {
        const int other = 1 - s.plane;
        return searches_[other]->nearest(sections_[other]->plane.to_uv(position(s)));
    }

    Crossing matched(const Sighting& p, const Sighting& q) const {
        if (contour(q) < contour(p)) return matched(q, p);
        const double ahead = p.passage.at - q.passage.at;
        const double distance_mm = std::min({std::abs(ahead), nearest_other(p).distance, nearest_other(q).distance});
        return {contour(p), contour(q), position(p), position(q), true, p.begins ? -ahead : ahead, distance_mm};
    }

    void append_unmatched(const Sighting& p, const Sighting& q, std::vector<Crossing>& crossings) const {
        const Section &own = *sections_[p.plane], &other = *sections_[1 - p.plane];
        const double half = (q.passage.at - p.passage.at) / 2;
        const double depth = depth_between(own, other.plane, line_, p.passage, q.passage);
        for (const Sighting& s : {p, q}) {
            const Section::Nearest nearest = nearest_other(s);
            const Vec3 there = other.plane.from_uv(nearest.position);
            const double outside = p.begins ? nearest.distance : -nearest.distance;
            crossings.push_back({contour(s), other.contours[nearest.outline], position(s), there, false, outside,
                                 std::min({nearest.distance, depth, half})});
        }
    }

    const Section* sections_[2];
    const SectionSearch* searches_[2];
    SpanLine line_;
};

void add(const Crossing& crossing, Disagreement& sum) {
    const double d = crossing.disagreement_mm;
    if (!crossing.matched) {
        ++sum.unmatched;
        sum.max_unmatched_mm = std::max(sum.max_unmatched_mm, d);
        return;
    }
    ++sum.matched;
    sum.mean_mm += d;
    sum.rms_mm += d * d;
    sum.max_mm = std::max(sum.max_mm, d);
}

void divide(Disagreement& sum) {
    if (sum.matched == 0) return;
    sum.mean_mm /= static_cast<double>(sum.matched);
    sum.rms_mm = std::sqrt(sum.rms_mm / static_cast<double>(sum.matched));
}

}  // namespace

std::vector<Crossing> find_crossings(const ContourSet& set) {
    const std::vector<BoxedSection> planes = drawn_planes(set);
    const Vec3 center = bounding_box(set).center();
    std::vector<SearchableSection> searchable;
    searchable.reserve(planes.size());
    for (const BoxedSection& boxed : planes) searchable.push_back({boxed.section, SectionSearch(boxed.section)});
    std::vector<Crossing> crossings;
    for (std::size_t a = 0; a < planes.size(); ++a)
        for (std::size_t b = a + 1; b < planes.size(); ++b) {
            const Section &first = planes[a].section, &second = planes[b].section;
            if (!reaches(planes[a].box, second.plane) && !reaches(planes[b].box, first.plane)) continue;
            if (const auto line = common_line(first.plane, second.plane, center))
                PlanePair(searchable[a], searchable[b], *line).append_to(crossings);
        }
    return crossings;
}

std::string sentence(const Crossing& c) {
    const std::string what = c.matched
                                 ? fmt::format("passes {:.2g} mm {} of contour {}", c.disagreement_mm,
                                               c.distance_mm < 0 ? "inside" : "outside", c.other + 1)
                                 : fmt::format("shows {} where the plane of contour {} shows none, by {:.2g} mm",
                                               c.distance_mm < 0 ? "a gap" : "the object", c.other + 1, c.disagreement_mm);
    return fmt::format("contour {} {} at ({:.1f}, {:.1f}, {:.1f}) mm", c.contour + 1, what, c.position.x, c.position.y,
                       c.position.z);
}

Disagreement disagreement(std::span<const Crossing> crossings) {
    Disagreement result;
    for (const Crossing& crossing : crossings) add(crossing, result);
    divide(result);
    return result;
}

std::vector<Disagreement> disagreement_by_contour(std::span<const Crossing> crossings, std::size_t contour_count) {
    std::vector<Disagreement> result(contour_count);
    for (const Crossing& crossing : crossings)
        for (const std::size_t contour : {crossing.contour, crossing.other}) add(crossing, result[contour]);
    for (Disagreement& sum : result) divide(sum);
    return result;
}

}  // namespace kontur
