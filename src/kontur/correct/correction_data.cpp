// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/correction_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/point_tree.h"
#include "kontur/base/smooth_step.h"
#include "kontur/shape/crossings.h"

namespace kontur {
namespace {

// Ratios to lengths of the mask. Behind some: mean Dice of 13 masks after three axial planes (bench/correct.py) by other
// values, where these make .9401.
constexpr double kSpacingOfLength = 0.4,
                 kSpacingOfRadius = 1.0 / 15;  ///< the lesser, two voxels at least. x .7 .9381, x 1.5 .9406
constexpr double kLineNoise = 0.02;            ///< of the step
// Of the step: noise of a line where it repeats the mask's, which fades out where it moves so far. f0 is known to that, and
// what it is wrong by would be carried on. Half and twice: the same but for .0015 with planes in any direction.
constexpr double kRepeatedNoise = 0.3, kRepeatedUpTo = 2;
constexpr double kSlope = 0.9;        ///< of the distance from a moved line: what f is beside it. Nothing there .9388
constexpr double kSlopeNoise = 0.3;   ///< of that distance
constexpr double kLeast = 0.7;        ///< of the distance from the outline: what f is at least
constexpr double kDepthVoxels = 0.5;  ///< tau, of the largest voxel side. .35 .9365, .8 .9392
// Lengths l from what another plane moved: nothing of a kept outline counts, and all of it. From .5 to 1 a leak that a
// stroke took away comes back by half; a stroke is seldom drawn to say what is right beside it.
constexpr double kYielding = 1, kKept = 2;
constexpr double kLeastKept = 0.01;  ///< of its weight

/// A section and searches in it.
struct SearchedSection {
    explicit SearchedSection(const CorrectedSection& of) : section(of), before(of.before), after(of.after) {}

    const CorrectedSection& section;
    SectionSearch before, after;

    /// Distance from the corrected outline, positive inside; without an outline, from the one before.
    double depth(const Point2& p, double step) const {
        if (section.after.outlines.empty()) return -std::max(before.clearance(p), step);
        return after.contains(p) ? after.clearance(p) : -after.clearance(p);
    }
    bool is_changed(const Point2& p) const { return before.contains(p) != after.contains(p); }
};

/// A point of a drawn line, and the direction to its left.
struct LinePoint {
    Point2 position, left;
};

std::vector<LinePoint> resampled(const DrawnLine& line, double spacing) {
    std::vector<double> along{0};
    const std::size_t edges = line.points.size() - (line.closed ? 0 : 1);
    const auto point = [&](std::size_t n) { return line.points[n % line.points.size()]; };
    for (std::size_t e = 0; e < edges; ++e)
        along.push_back(along.back() + std::hypot(point(e + 1)[0] - point(e)[0], point(e + 1)[1] - point(e)[1]));
    const auto count = std::max<std::size_t>(4, static_cast<std::size_t>(std::ceil(along.back() / spacing)));
    std::vector<LinePoint> points;
    std::size_t e = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const double parts = static_cast<double>(line.closed ? count : count - 1);
        const double place = along.back() * static_cast<double>(n) / parts;
        while (e + 1 < edges && along[e + 1] < place) ++e;
        const Point2 a = point(e), b = point(e + 1);
        const double length = along[e + 1] - along[e], t = length > 0 ? (place - along[e]) / length : 0;
        const Point2 left = length > 0 ? Point2{-(b[1] - a[1]) / length, (b[0] - a[0]) / length} : Point2{0, 0};
        points.push_back({{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])}, left});
    }
    return points;
}

/// Collects what the sections say.
class Collector {
public:
    Collector(const ExistingSurface& surface, const CorrectionLengths& lengths) : surface_(surface), lengths_(lengths) {}

    void add_lines(const SearchedSection& searched, std::size_t number) {
        for (const DrawnLine& line : searched.section.lines) add_line(searched, number, line);
    }

    /// After all lines. Where only a piece of a plane's outline was replaced, the rest was right as it was seen. Near what
    /// other planes moved that is not how the mask has it, so the mask's outline yields there.
    void yield_to_others(const std::vector<SearchedSection>& searched) {
        std::vector<std::vector<Vec3>> moved(searched.size());
        const auto add_moved = [&](const Vec3& place, std::size_t by) {
            for (std::size_t n = 0; n < searched.size(); ++n)
                if (n != by && !searched[n].section.redrawn) moved[n].push_back(place);
        };
        for (const CorrectionDatum& datum : found.data)
            if (is_moved(datum)) add_moved(datum.position, datum.section);
        for (std::size_t n = 0; n < searched.size(); ++n)
            for_each_place(searched[n].section, lengths_.spacing, [&](const Point2& p) {
                if (searched[n].is_changed(p)) add_moved(searched[n].section.plane.from_uv(p), n);
            });
        for (std::vector<Vec3>& places : moved) moved_by_others_.emplace_back(std::move(places));
        std::erase_if(found.data, [&](CorrectionDatum& datum) {
            if (searched[datum.section].section.redrawn || is_moved(datum)) return false;
            const double far =
                smooth_step(kYielding, kKept, moved_by_others_[datum.section].distance_to(datum.position) / lengths_.length);
            datum.noise_mm /= std::max(far, kLeastKept);
            return far < kLeastKept;
        });
    }

    /// After yield_to_others.
    void add_bounds(const std::vector<SearchedSection>& searched, std::size_t number) {
        if (!near_) find_moved(searched);
        add_plane_bounds(searched[number], number);
        if (mask_shows_nothing(searched[number].section)) add_ends(searched, number);
    }

    void add_points(const std::vector<Vec3>& points, double sign, std::size_t number) {
        for (const Vec3& p : points) found.bounds.push_back({p, sign, lengths_.depth, number});
    }

    CorrectionData found;

private:
    void add_line(const SearchedSection& searched, std::size_t number, const DrawnLine& line) {
        const Plane& plane = searched.section.plane;
        const double h = lengths_.step, noise = kLineNoise * h / std::sqrt(line.weight);
        const std::vector<LinePoint> points = resampled(line, lengths_.spacing);
        const auto count = static_cast<std::ptrdiff_t>(points.size());
        std::vector<double> off;
        for (const LinePoint& p : points) off.push_back(std::abs(surface_.value(plane.from_uv(p.position))));
        const auto is_still = [&](std::ptrdiff_t n) {
            for (std::ptrdiff_t m = n - 2; m <= n + 2; ++m)
                if (off[static_cast<std::size_t>((m % count + count) % count)] >= kStillVoxels * h) return false;
            return true;
        };
        for (std::ptrdiff_t n = 0; n < count; ++n) {
            const LinePoint& p = points[static_cast<std::size_t>(n)];
            if (is_still(n) && n % 2 == 1) continue;
            const double repeats = 1 - smooth_step(0, kRepeatedUpTo, off[static_cast<std::size_t>(n)] / h);
            found.data.push_back({plane.from_uv(p.position), 0, std::max(noise, kRepeatedNoise * h * repeats), number});
            if (off[static_cast<std::size_t>(n)] > h) add_slope(searched, number, p);
        }
    }

    /// Beside a moved line f falls outwards.
    void add_slope(const SearchedSection& searched, std::size_t number, const LinePoint& p) {
        const double apart = std::max(1.5 * lengths_.step, 0.5 * lengths_.spacing);
        for (const double side : {1.0, -1.0}) {
            const Point2 q{p.position[0] + side * apart * p.left[0], p.position[1] + side * apart * p.left[1]};
            const double depth = kSlope * searched.depth(q, lengths_.step);
            found.data.push_back({searched.section.plane.from_uv(q), std::clamp(depth, -lengths_.depth, lengths_.depth),
                                  kSlopeNoise * apart, number});
        }
    }

    bool is_moved(const CorrectionDatum& datum) const {
        return std::abs(datum.value_mm - surface_.value(datum.position)) > kStillVoxels * lengths_.step;
    }

    /// Where and how far lines move, once all are there.
    void find_moved(const std::vector<SearchedSection>& searched) {
        std::vector<Vec3> moved;
        for (const CorrectionDatum& datum : found.data) {
            const double change = std::abs(datum.value_mm - surface_.value(datum.position));
            if (change <= 0.2 * lengths_.step) continue;
            moved.push_back(datum.position);
            largest_change_ = std::max(largest_change_, change);
        }
        for (const SearchedSection& s : searched)  // planes in which the object is no more
            if (s.section.after.outlines.empty())
                for (const Polygon2& outline : s.section.before.outlines)
                    for (const LinePoint& p : resampled({outline, true, 1}, lengths_.spacing))
                        moved.push_back(s.section.plane.from_uv(p.position));
        near_.emplace(std::move(moved));
    }

    /// Where nothing changes no bound asks for more than the mask has.
    void add_bound(const SearchedSection& searched, std::size_t number, const Point2& p) {
        const double depth = searched.depth(p, lengths_.step);
        if (std::abs(depth) <= 0.5 * lengths_.step) return;
        const Vec3 at = searched.section.plane.from_uv(p);
        double least = std::min(lengths_.depth, kLeast * std::abs(depth));
        if (!searched.is_changed(p)) least = std::min(least, std::abs(surface_.value(at)));
        found.bounds.push_back({at, depth > 0 ? 1.0 : -1.0, least, number});
    }

    void add_plane_bounds(const SearchedSection& searched, std::size_t number) {
        const double h = lengths_.step;
        for_each_place(searched.section, h, [&](const Point2& p) {
            const Vec3 at = searched.section.plane.from_uv(p);
            if (near_->distance_to(at) > kReachLengths * lengths_.length) return;
            const bool changed = searched.is_changed(p);
            if (!changed && std::abs(surface_.value(at)) > largest_change_ + 2 * h) return;
            if (!changed && moved_by_others_[number].distance_to(at) < kYielding * lengths_.length) return;
            add_bound(searched, number, p);
        });
    }

    /// Calls visit(p) on a lattice over the outlines before and after, and two steps around them.
    template <class Visit>
    static void for_each_place(const CorrectedSection& section, double step, const Visit& visit) {
        Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        Point2 high{-low[0], -low[1]};
        for (const Section* s : {&section.before, &section.after})
            for (const Polygon2& outline : s->outlines)
                for (const Point2& p : outline)
                    for (const int axis : {0, 1}) {
                        low[axis] = std::min(low[axis], p[axis]);
                        high[axis] = std::max(high[axis], p[axis]);
                    }
        if (!(low[0] <= high[0])) return;
        const auto from = [&](double x) { return static_cast<std::int64_t>(std::floor(x / step)) - 2; };
        const auto to = [&](double x) { return static_cast<std::int64_t>(std::ceil(x / step)) + 2; };
        for (std::int64_t j = from(low[1]); j <= to(high[1]); ++j)
            for (std::int64_t i = from(low[0]); i <= to(high[0]); ++i)
                visit(Point2{static_cast<double>(i) * step, static_cast<double>(j) * step});
    }

    static bool mask_shows_nothing(const CorrectedSection& section) {
        return section.before.outlines.empty() && !section.after.outlines.empty();
    }

    /// Distance from a plane to the mask along its normal times `side`, over a section's points; infinity without one.
    double distance_to_mask(const Plane& plane, const std::vector<Point2>& points, double side) const {
        const double reach = kReachLengths * lengths_.length, h = lengths_.step;
        for (double t = 0.5 * h; t <= reach; t += 0.5 * h)
            for (const Point2& p : points)
                if (surface_.value(plane.from_uv(p) + side * t * plane.normal) > 0) return t;
        return std::numeric_limits<double>::infinity();
    }

    /// A section where the mask has none lengthens it. Beyond, it goes on no farther than the section lies from the mask.
    void add_ends(const std::vector<SearchedSection>& searched, std::size_t number) {
        const Plane& plane = searched[number].section.plane;
        std::vector<Point2> points;
        for (const CorrectionBound& bound : found.bounds)
            if (bound.section == number && bound.sign > 0) points.push_back(plane.to_uv(bound.position));
        if (points.empty()) return;
        const double ahead = distance_to_mask(plane, points, 1), back = distance_to_mask(plane, points, -1);
        if (std::isinf(ahead) == std::isinf(back)) return;
        const double side = std::isinf(ahead) ? 1 : -1;
        const double gap = std::max(std::min(ahead, back), slice_distance(plane.normal));
        for (std::size_t other = 0; other < searched.size(); ++other) {
            const CorrectedSection& s = searched[other].section;
            const double beyond = side * plane.distance_to(s.plane.origin);
            if (other != number && !s.after.outlines.empty() && are_parallel(s.plane, plane) && beyond > 0) return;
        }
        for (const Point2& p : points)
            found.bounds.push_back({plane.from_uv(p) + side * gap * plane.normal, -1, lengths_.depth, number});
    }

    /// Of the grid's voxels along a direction.
    double slice_distance(const Vec3& direction) const {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis)
            most = std::max(most, std::abs(dot(direction, surface_.grid().index_to_mm.column(axis))));
        return most;
    }

    const ExistingSurface& surface_;
    const CorrectionLengths& lengths_;
    std::optional<PointTree> near_;           ///< of what moves
    std::vector<PointTree> moved_by_others_;  ///< of each plane in which only a piece was replaced
    double largest_change_ = 0;
};

/// Contours that contradict each other by more than a voxel: both yield, as far as they do.
void relax_contradictions(const ContourSet& drawing, double step_mm, CorrectionData& data) {
    for (const Crossing& crossing : find_crossings(drawing)) {
        if (!crossing.matched || crossing.disagreement_mm <= step_mm) continue;
        data.contradictions.push_back(sentence(crossing) + "; both yield there");
        for (CorrectionDatum& datum : data.data) {
            const double apart =
                std::min(distance(datum.position, crossing.position), distance(datum.position, crossing.other_position));
            if (apart < 2 * crossing.disagreement_mm)
                datum.noise_mm = std::max(datum.noise_mm, 0.5 * crossing.disagreement_mm);
        }
    }
}

}  // namespace

CorrectionLengths correction_lengths(const ExistingSurface& surface, double reach) {
    const Vec3 spacing = surface.grid().spacing_mm();
    CorrectionLengths lengths{};
    lengths.length = reach * correction_length_mm(surface);
    lengths.step = smallest(spacing);
    lengths.spacing =
        std::max(2 * lengths.step, std::min(kSpacingOfLength * lengths.length, kSpacingOfRadius * surface.radius_mm()));
    lengths.depth = kDepthVoxels * largest(spacing);
    return lengths;
}

CorrectionData correction_data(const ExistingSurface& surface, const std::vector<CorrectedSection>& sections,
                               const ContourSet& drawing, const CorrectionLengths& lengths) {
    std::vector<SearchedSection> searched;
    searched.reserve(sections.size());
    for (const CorrectedSection& section : sections) searched.emplace_back(section);
    Collector collector(surface, lengths);
    for (std::size_t n = 0; n < searched.size(); ++n) collector.add_lines(searched[n], n);
    collector.yield_to_others(searched);
    for (std::size_t n = 0; n < searched.size(); ++n) collector.add_bounds(searched, n);
    collector.add_points(drawing.interior, 1, sections.size());
    collector.add_points(drawing.exterior, -1, sections.size());
    for (const CorrectedSection& section : sections) collector.found.moved_shares.push_back(section.moved_share);
    collector.found.moved_shares.push_back(1);  // points
    relax_contradictions(drawing, lengths.step, collector.found);
    return std::move(collector.found);
}

}  // namespace kontur
