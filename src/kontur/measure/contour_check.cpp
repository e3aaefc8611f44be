// SPDX-License-Identifier: Apache-2.0
// What a contour shows by itself.
#include "kontur/measure/contour_check.h"
#include "kontur/base/counted.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/measure/findings.h"
#include "kontur/shape/self_intersections.h"

namespace kontur {
namespace {

/// One contour under examination; repeated points are left out of `points`.
class Examination {
public:
    Examination(const Contour& contour, std::size_t index, const ContourCheckOptions& limits, std::vector<Finding>& findings)
        : contour_(contour), index_(index), limits_(limits), findings_(findings), points_(contour.points) {
        points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
        while (contour.closed && points_.size() > 1 && points_.back() == points_.front()) points_.pop_back();
    }

    bool run() {
        if (!is_finite_and_long_enough() || is_refused()) return false;
        find_repeated_points();
        find_uneven_edges();
        if (contour_.closed) find_self_intersections();
        return true;
    }

private:
    void add(FindingKind kind, Severity severity, const std::string& predicate, std::optional<Vec3> position = {},
             std::optional<double> value_mm = {}) {
        findings_.push_back({kind, severity, contour_name(index_) + " " + predicate, index_, {}, position, value_mm});
    }

    std::size_t edge_count() const { return contour_.closed ? points_.size() : points_.size() - 1; }
    const Vec3& point(std::size_t i) const { return points_[i % points_.size()]; }
    double edge_length(std::size_t i) const { return distance(point(i), point(i + 1)); }

    bool is_finite_and_long_enough() {
        const auto bad =
            std::find_if(contour_.points.begin(), contour_.points.end(), [](const Vec3& p) { return !is_finite(p); });
        if (bad != contour_.points.end()) {
            add(FindingKind::not_finite, Severity::error,
                fmt::format("has a NaN or infinite coordinate in point {}", bad - contour_.points.begin() + 1));
            return false;
        }
        const std::size_t least = contour_.closed ? 3 : 2;
        if (points_.size() >= least) return true;
        const std::optional<Vec3> where = points_.empty() ? std::nullopt : std::optional(points_.front());
        add(FindingKind::too_few_points, Severity::error,
            fmt::format("has {}; at least {} are needed", counted(points_.size(), "different point"), least), where);
        return false;
    }

    /// By contour_problem, once repeated points are left out.
    bool is_refused() {
        Contour cleaned = contour_;
        cleaned.points = points_;
        const std::optional<std::string> problem = contour_problem(cleaned, contour_name(index_), limits_);
        if (!problem) return false;
        const auto off_plane = [&](const Vec3& p) { return std::abs(contour_.plane.distance_to(p)); };
        const Vec3 worst = *std::max_element(points_.begin(), points_.end(),
                                             [&](const Vec3& a, const Vec3& b) { return off_plane(a) < off_plane(b); });
        const double off = off_plane(worst), width = width_mm(points_);
        if (problem->find("off its plane") != std::string::npos)
            add(FindingKind::off_plane, Severity::error, fmt::format("has a point {:.3g} mm off its plane", off), worst,
                off);
        else if (problem->find("no area") != std::string::npos)
            add(FindingKind::no_area, Severity::error, fmt::format("has no area: it is {:.2g} mm wide", width),
                points_.front(), width);
        else findings_.push_back({FindingKind::unusable, Severity::error, *problem, index_});
        return true;
    }

    void find_repeated_points() {
        const std::size_t count = contour_.points.size() - points_.size();
        if (count == 0) return;
        const auto first = std::adjacent_find(contour_.points.begin(), contour_.points.end());
        add(FindingKind::repeated_points, Severity::note,
            count == 1 ? "repeats a point" : fmt::format("repeats {} points", count),
            first == contour_.points.end() ? contour_.points.back() : *first);
    }

    void find_uneven_edges() {
        std::vector<double> lengths;
        for (std::size_t i = 0; i < edge_count(); ++i) lengths.push_back(edge_length(i));
        const std::size_t longest =
            static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
        double perimeter = 0;
        for (const double length : lengths) perimeter += length;
        const double length = lengths[longest];
        std::nth_element(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2), lengths.end());
        const double usual = lengths[lengths.size() / 2];

        const double ends = distance(points_.front(), points_.back());
        if (!contour_.closed && ends < std::max(2 * usual, 0.01 * perimeter))
            add(FindingKind::maybe_closed, Severity::warning, fmt::format("is open, but its ends are {:.2g} mm apart", ends),
                points_.front(), ends);
        // Straight runs along voxel edges are long as well; a fifth of the perimeter is not one of them.
        if (length < 10 * usual || length < 0.2 * perimeter) return;
        const Vec3 middle = 0.5 * (point(longest) + point(longest + 1));
        if (contour_.closed && longest + 1 == points_.size())
            add(FindingKind::maybe_open, Severity::warning,
                fmt::format("is closed by an edge of {:.3g} mm, {:.0f} times its usual one; was it left open?", length,
                            length / usual),
                middle, length);
        else
            add(FindingKind::long_edge, Severity::note,
                fmt::format("has an edge of {:.3g} mm, {:.0f} times its usual one", length, length / usual), middle, length);
    }

    void find_self_intersections() {
        Polygon2 polygon;
        for (const Vec3& p : points_) polygon.push_back(contour_.plane.to_uv(p));
        polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
        if (polygon.size() < 3) return;
        std::array<std::vector<Vec3>, 3> places;  // by kind
        for (const SelfIntersection& c : kontur::find_self_intersections(polygon).places)
            places[static_cast<std::size_t>(c.kind)].push_back(contour_.plane.from_uv(c.position));
        const auto report = [&](SelfIntersection::Kind kind, FindingKind finding, Severity severity, const char* what) {
            const std::vector<Vec3>& at = places[static_cast<std::size_t>(kind)];
            if (at.empty()) return;
            add(finding, severity, at.size() == 1 ? std::string(what) : fmt::format("{} in {} places", what, at.size()),
                at.front());
        };
        report(SelfIntersection::Kind::crossing, FindingKind::self_crossing, Severity::warning, "crosses itself");
        report(SelfIntersection::Kind::touch, FindingKind::self_touch, Severity::note, "touches itself");
        report(SelfIntersection::Kind::fold, FindingKind::spike, Severity::warning, "runs back on itself");
        if (places[static_cast<std::size_t>(SelfIntersection::Kind::fold)].empty()) find_narrow_spike();
    }

    /// A turn by almost 180 degrees between edges that are no shorter than usual.
    void find_narrow_spike() {
        constexpr double kCosine = -0.996;  // 5 degrees
        double total = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) total += edge_length(i);
        const double average = total / static_cast<double>(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const Vec3 in = point(i + 1) - point(i), out = point(i + 2) - point(i + 1);
            const double length = std::min(norm(in), norm(out));
            if (length < average || dot(in, out) > kCosine * norm(in) * norm(out)) continue;
            return add(FindingKind::spike, Severity::warning, fmt::format("has a spike of {:.3g} mm", length), point(i + 1),
                       length);
        }
    }

    const Contour& contour_;
    std::size_t index_;
    const ContourCheckOptions& limits_;
    std::vector<Finding>& findings_;
    std::vector<Vec3> points_;
};

}  // namespace

std::string_view name(Severity severity) noexcept {
    constexpr std::array<std::string_view, 3> kNames{"note", "warning", "error"};
    return kNames[static_cast<std::size_t>(severity)];
}

std::string_view name(FindingKind kind) noexcept {
    constexpr std::array<std::string_view, 27> kNames{
        "no_contours",      "too_few_points",  "not_finite",   "off_plane",     "no_area",
        "unusable",         "repeated_points", "spike",        "self_crossing", "self_touch",
        "long_edge",        "maybe_open",      "maybe_closed", "tiny",          "duplicate",
        "overlap",          "unmarked_hole",   "thin_wall",    "stray_hole",    "contradiction",
        "misplaced_point",  "isolated",        "gap",          "far_rings",     "one_plane",
        "implausible_size", "far_away"};
    static_assert(kNames.size() == static_cast<std::size_t>(FindingKind::far_away) + 1);
    return kNames[static_cast<std::size_t>(kind)];
}

std::string contour_name(std::size_t index) { return fmt::format("contour {}", index + 1); }

bool check_one_contour(const Contour& contour, std::size_t index, const ContourCheckOptions& limits,
                       std::vector<Finding>& findings) {
    return Examination(contour, index, limits, findings).run();
}

}  // namespace kontur
