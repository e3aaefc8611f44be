// SPDX-License-Identifier: Apache-2.0
// What contours show beside each other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "kontur/base/checks.h"
#include "kontur/measure/bent_ways.h"
#include "kontur/measure/contour_check.h"
#include "kontur/measure/findings.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/crossings.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/find_near_lines.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// The sound contours of a set, with the index that each has in the set.
struct Sound {
    ContourSet set;
    std::vector<std::size_t> index;
};

/// With nested contours as holes.
struct FilledSet {
    explicit FilledSet(ContourSet drawing) : set(std::move(drawing)), changes(apply_fill_rule(set, FillRule::even_odd)) {}

    ContourSet set;
    FillChanges changes;
};

class SetCheck {
public:
    SetCheck(const Sound& sound, const ContourSetCheckOptions& options, std::vector<Finding>& findings)
        : set_(sound.set),
          index_(sound.index),
          findings_(findings),
          box_(bounding_box(set_)),
          diameter_(diameter_mm(set_)),
          filled_(set_),
          sections_(sections_of(filled_.set, kSamePlane * diameter_)),
          limit_(options.disagreement_mm.value_or(0.015 * diameter_)) {}

    void run() {
        find_size();
        find_tiny();
        find_duplicates();
        find_near_lines();
        find_holes_and_overlaps();
        find_contradictions();
        find_misplaced(set_.interior, true);
        find_misplaced(set_.exterior, false);
        find_misplaced_on_surface();
        find_isolated();
        find_gaps();
        find_far_rings();
        if (sections_.size() == 1)
            add(FindingKind::one_plane, Severity::note,
                "all contours lie in one plane; how thick the object is will be a guess from their width");
    }

private:
    using Pair = std::pair<std::size_t, std::size_t>;

    const Contour& contour(std::size_t c) const { return set_.contours[c]; }
    std::string title(std::size_t c) const { return contour_name(index_[c]); }

    Finding& add(FindingKind kind, Severity severity, std::string text) {
        return findings_.emplace_back(Finding{kind, severity, std::move(text)});
    }
    Finding& add(FindingKind kind, Severity severity, std::size_t c, const std::string& predicate) {
        Finding& finding = add(kind, severity, title(c) + " " + predicate);
        finding.contour = index_[c];
        finding.position = bounding_box(contour(c).points).center();
        return finding;
    }

    void find_size() {
        if (diameter_ < 1 || diameter_ > 3000)
            add(FindingKind::implausible_size, Severity::warning,
                fmt::format("the contours span {:.3g} mm; are their coordinates really millimetres?", diameter_))
                .value_mm = diameter_;
        if (const double away = norm(box_.center()); away > 10000) {
            Finding& finding = add(FindingKind::far_away, Severity::warning,
                                   fmt::format("the contours lie {:.3g} mm from the origin", away));
            finding.position = box_.center();
            finding.value_mm = away;
        }
    }

    void find_tiny() {
        for (std::size_t c = 0; c < set_.contours.size(); ++c) {
            const double width = width_mm(contour(c).points);
            if (!contour(c).closed || width > 0.0075 * diameter_) continue;
            add(FindingKind::tiny, Severity::note, c, fmt::format("is only {:.2g} mm wide", width)).value_mm = width;
        }
    }

    bool lies_on(const Contour& inner, const Section& outline, double tolerance) const {
        return std::all_of(inner.points.begin(), inner.points.end(),
                           [&](const Vec3& p) { return outline.clearance(outline.plane.to_uv(p)) < tolerance; });
    }

    static Section outline_alone(const Section& section, std::size_t o) {
        return {section.plane, {section.outlines[o]}, {}, {}};
    }

    void find_duplicates() {
        for (const Section& section : sections_)
            for (std::size_t a = 0; a < section.outlines.size(); ++a)
                for (std::size_t b = a + 1; b < section.outlines.size(); ++b) {
                    const std::size_t first = section.contours[a], second = section.contours[b];
                    const Box3 box = bounding_box(contour(first).points), other = bounding_box(contour(second).points);
                    const double tolerance = 1e-3 * box.diagonal();
                    if (distance(box.min, other.min) > 2 * tolerance || distance(box.max, other.max) > 2 * tolerance)
                        continue;
                    if (!lies_on(contour(second), outline_alone(section, a), tolerance) ||
                        !lies_on(contour(first), outline_alone(section, b), tolerance))
                        continue;
                    duplicates_.emplace_back(first, second);
                    add(FindingKind::duplicate, Severity::warning, second, "repeats " + title(first)).other = index_[first];
                }
    }

    bool is_duplicate(std::size_t a, std::size_t b) const {
        return std::find(duplicates_.begin(), duplicates_.end(), std::minmax({a, b})) != duplicates_.end();
    }

    /// Two lines of one plane that count as one, or leave a thin wall.
    void find_near_lines() {
        for (const NearLines& pair : filled_.changes.near_lines) {
            if (is_duplicate(pair.contour, pair.other)) continue;
            const auto [first, second] = std::minmax({pair.contour, pair.other});
            Finding& finding =
                pair.is_one
                    ? add(FindingKind::duplicate, Severity::warning, second,
                          fmt::format("and {} of the same plane, {:.2g} mm apart, count as one line that was drawn "
                                      "twice; where a wall is meant, mark the inner one as a hole",
                                      title(first), pair.apart_mm))
                    : add(FindingKind::thin_wall, Severity::warning, pair.contour,
                          fmt::format("lies inside of {} and counts as a hole, which leaves a wall of {:.2g} mm; where "
                                      "it is the same line drawn again, remove one of the two",
                                      title(pair.other), pair.apart_mm));
            finding.other = index_[pair.is_one ? first : pair.other];
            finding.value_mm = pair.apart_mm;
        }
    }

    bool are_near(std::size_t a, std::size_t b) const {
        return std::ranges::any_of(filled_.changes.near_lines, [&](const NearLines& pair) {
            return std::minmax({pair.contour, pair.other}) == std::minmax({a, b});
        });
    }

    void find_holes_and_overlaps() {
        const Nesting nesting = find_nesting(set_.contours, kSamePlane * diameter_);
        for (std::size_t c = 0; c < set_.contours.size(); ++c) {
            std::vector<std::size_t> around = nesting.enclosing[c];
            std::erase_if(around, [&](std::size_t other) { return is_duplicate(c, other); });
            const bool nested = around.size() % 2 != 0;
            if (nested && !contour(c).hole && !are_near(c, around.front()))
                add(FindingKind::unmarked_hole, Severity::note, c,
                    "lies inside of " + title(around.front()) +
                        " and is not marked as a hole; it counts as one unless only declared holes do")
                    .other = index_[around.front()];
            if (!nested && contour(c).hole)
                add(FindingKind::stray_hole, Severity::warning, c,
                    around.empty()
                        ? std::string("is a hole, but no contour of its plane surrounds it")
                        : fmt::format("is a hole inside of {} contours, which leaves it outside already", around.size()));
        }
        for (const auto& [a, b] : nesting.crossings) {
            if (is_duplicate(a, b) || are_near(a, b)) continue;
            Finding& finding =
                add(FindingKind::overlap, Severity::warning, a, "and " + title(b) + " of the same plane cross");
            finding.other = index_[b];
            if (const auto at = first_crossing(a, b)) finding.position = at;
        }
    }

    std::optional<Vec3> first_crossing(std::size_t a, std::size_t b) const {
        const Plane& plane = contour(a).plane;
        const auto &p = contour(a).points, &q = contour(b).points;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Point2 p0 = plane.to_uv(p[i]), p1 = plane.to_uv(p[(i + 1) % p.size()]);
            for (std::size_t j = 0; j < q.size(); ++j)
                if (meeting(p0, p1, plane.to_uv(q[j]), plane.to_uv(q[(j + 1) % q.size()])) != Meeting::apart)
                    return 0.5 * (p[i] + p[(i + 1) % p.size()]);
        }
        return std::nullopt;
    }

    void find_contradictions() {
        crossings_ = find_crossings(set_);
        std::map<Pair, const Crossing*> worst;
        for (const Crossing& c : crossings_) {
            if (c.disagreement_mm <= limit_) continue;
            const Crossing*& seen = worst[{std::min(c.contour, c.other), std::max(c.contour, c.other)}];
            if (!seen || c.disagreement_mm > seen->disagreement_mm) seen = &c;
        }
        for (const auto& [pair, c] : worst) {
            Crossing in_set = *c;
            in_set.contour = index_[c->contour];
            in_set.other = index_[c->other];
            Finding& finding = add(FindingKind::contradiction, Severity::warning, sentence(in_set));
            finding.contour = in_set.contour;
            finding.other = in_set.other;
            finding.position = c->position;
            finding.value_mm = c->disagreement_mm;
        }
    }

    void find_misplaced(const std::vector<Vec3>& points, bool inside) {
        for (const Vec3& p : points)
            for (const Section& section : sections_) {
                const Point2 at = section.plane.to_uv(p);
                if (std::abs(section.plane.distance_to(p)) > 1.5e-3 * diameter_ || section.contains(at) == inside) continue;
                if (section.clearance(at) < 1.5e-3 * diameter_ || has_open(section)) continue;
                Finding& finding = add(FindingKind::misplaced_point, Severity::warning,
                                       inside ? "an interior point lies outside of the contours of its plane"
                                              : "an exterior point lies inside of the contours of its plane");
                finding.position = p;
                finding.value_mm = section.clearance(at);
                break;
            }
    }
    /// Surface points that lie off the contours of a drawn plane.
    void find_misplaced_on_surface() {
        for (std::size_t i = 0; i < set_.surface.size(); ++i)
            for (const Section& section : sections_) {
                const Vec3& p = set_.surface[i].position;
                const double clearance = section.clearance(section.plane.to_uv(p));
                if (std::abs(section.plane.distance_to(p)) > 1.5e-3 * diameter_ || clearance <= limit_ || has_open(section))
                    continue;
                Finding& finding =
                    add(FindingKind::misplaced_point, Severity::warning,
                        fmt::format("surface point {} lies {:.3g} mm from the contours of its plane", i + 1, clearance));
                finding.position = p;
                finding.value_mm = clearance;
                break;
            }
    }

    bool has_open(const Section& section) const {
        return std::any_of(section.contours.begin(), section.contours.end(),
                           [&](std::size_t c) { return !contour(c).closed; });
    }

    /// Whether a contour of another, parallel plane lies over this one, no farther than three times its size.
    bool has_neighbour(std::size_t c) const {
        const Plane& plane = contour(c).plane;
        const auto shadow = [&](const Contour& line) {
            Box3 box;
            for (const Vec3& p : line.points) {
                const Point2 at = plane.to_uv(p);
                box.extend({at[0], at[1], 0});
            }
            return box;
        };
        const Box3 own = shadow(contour(c));
        for (const Contour& other : set_.contours) {
            const double height = std::abs(plane.distance_to(other.plane.origin));
            if (height < 1.5e-4 * diameter_ || height > 3 * own.diagonal()) continue;
            if (std::abs(dot(plane.normal, other.plane.normal)) < 0.95) continue;
            const Box3 theirs = shadow(other);
            if (own.min.x < theirs.max.x && theirs.min.x < own.max.x && own.min.y < theirs.max.y && theirs.min.y < own.max.y)
                return true;
        }
        return false;
    }

    void find_isolated() {
        if (sections_.size() < 2) return;
        const std::vector<Disagreement> by_contour = disagreement_by_contour(crossings_, set_.contours.size());
        for (std::size_t c = 0; c < set_.contours.size(); ++c)
            if (contour(c).closed && by_contour[c].matched == 0 && !has_neighbour(c))
                add(FindingKind::isolated, Severity::note, c,
                    "stands alone: no other contour tells how the object goes on from it");
    }

    /// Sections of a tube between which it may come apart: the two that are farthest apart for their width.
    void find_far_rings() {
        constexpr double kMostRadii = 5;
        std::vector<const Section*> sections;
        for (const Section& section : sections_) sections.push_back(&section);
        const std::pair<Ring, Ring>* worst = nullptr;
        const std::vector<std::pair<Ring, Ring>> pairs = ring_pairs(sections);
        double most = kMostRadii;
        int count = 0;
        for (const std::pair<Ring, Ring>& pair : pairs) {
            const auto& [a, b] = pair;
            const double radii = distance(a.middle, b.middle) / std::max(a.radius_mm, b.radius_mm);
            count += radii > kMostRadii;
            if (radii > most) most = radii, worst = &pair;
        }
        if (!worst) return;
        const auto& [a, b] = *worst;
        const double apart = distance(a.middle, b.middle);
        const std::string where = count == 1 ? "" : fmt::format(", the farthest of {} such pairs", count);
        Finding& finding = add(FindingKind::far_rings, Severity::note,
                               fmt::format("{} and {} lie {:.3g} mm apart, {:.1f} times their radius{}; a tube may come "
                                           "apart between them, and a contour there would carry it on",
                                           title(a.contour), title(b.contour), apart, most, where));
        finding.contour = index_[a.contour];
        finding.other = index_[b.contour];
        finding.position = 0.5 * (a.middle + b.middle);
        finding.value_mm = apart;
    }

    /// Missing slices in stacks of parallel planes that are evenly spaced otherwise.
    void find_gaps() {
        std::vector<bool> is_done(sections_.size());
        for (std::size_t s = 0; s < sections_.size(); ++s) {
            if (is_done[s]) continue;
            const Plane& plane = sections_[s].plane;
            std::vector<double> heights;
            for (std::size_t t = s; t < sections_.size(); ++t)
                if (std::abs(dot(plane.normal, sections_[t].plane.normal)) > 1 - 1e-6) {
                    is_done[t] = true;
                    heights.push_back(plane.distance_to(sections_[t].plane.origin));
                }
            find_gaps_in_stack(plane, std::move(heights));
        }
    }

    void find_gaps_in_stack(const Plane& plane, std::vector<double> heights) {
        if (heights.size() < 4) return;
        std::sort(heights.begin(), heights.end());
        std::vector<double> steps(heights.size());
        std::adjacent_difference(heights.begin(), heights.end(), steps.begin());
        steps.erase(steps.begin());
        std::vector<double> sorted = steps;
        std::sort(sorted.begin(), sorted.end());
        const double usual = sorted[sorted.size() / 2];
        const auto even =
            std::count_if(steps.begin(), steps.end(), [&](double d) { return std::abs(d - usual) < 0.1 * usual; });
        if (2 * even < static_cast<std::ptrdiff_t>(steps.size())) return;
        const Point2 middle = plane.to_uv(box_.center());
        for (std::size_t i = 0; i < steps.size(); ++i) {
            if (steps[i] < 1.5 * usual) continue;
            Finding& finding =
                add(FindingKind::gap, Severity::warning,
                    fmt::format("two neighbouring planes are {:.3g} mm apart, the others {:.3g} mm: {:.0f} missing",
                                steps[i], usual, steps[i] / usual - 1));
            finding.position = plane.from_uv(middle) + (heights[i] + steps[i] / 2) * plane.normal;
            finding.value_mm = steps[i];
        }
    }

    const ContourSet& set_;
    const std::vector<std::size_t>& index_;
    std::vector<Finding>& findings_;
    Box3 box_;
    double diameter_;
    FilledSet filled_;
    std::vector<Section> sections_;
    double limit_;
    std::vector<Pair> duplicates_;
    std::vector<Crossing> crossings_;
};

bool shows_the_object(const ContourSet& set) {
    return std::any_of(set.contours.begin(), set.contours.end(), [](const Contour& contour) { return !contour.hole; });
}

/// Beside others, contours without area are no reason to refuse the set.
void tell_lines_as_left_out(std::vector<Finding>& findings) {
    for (Finding& finding : findings) {
        if (finding.kind != FindingKind::no_area) continue;
        finding.severity = Severity::warning;
        finding.text += "; it is left out";
    }
}

}  // namespace

std::vector<Finding> check_contour_set(const ContourSet& set, const ContourSetCheckOptions& options) {
    check_tolerances(options.limits);
    if (options.disagreement_mm) check_not_below_0("how far contours may disagree", *options.disagreement_mm, " mm");
    std::vector<Finding> findings;
    Sound sound;
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if (check_one_contour(set.contours[c], c, options.limits, findings)) {
            sound.set.contours.push_back(set.contours[c]);
            sound.index.push_back(c);
        }
    if (shows_the_object(sound.set)) tell_lines_as_left_out(findings);
    for (const std::string& problem : set_problems(set))
        findings.push_back({findings.empty() && set.contours.empty() ? FindingKind::no_contours : FindingKind::unusable,
                            Severity::error, problem});
    const auto keep_finite = [](const std::vector<Vec3>& from, std::vector<Vec3>& to) {
        std::copy_if(from.begin(), from.end(), std::back_inserter(to), [](const Vec3& p) { return is_finite(p); });
    };
    keep_finite(set.interior, sound.set.interior);
    keep_finite(set.exterior, sound.set.exterior);
    std::copy_if(set.surface.begin(), set.surface.end(), std::back_inserter(sound.set.surface),
                 [](const SurfacePoint& p) { return is_finite(p.position); });
    sound.set.empty_planes = set.empty_planes;
    if (!sound.set.contours.empty()) SetCheck(sound, options, findings).run();
    std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        return std::pair(-static_cast<int>(a.severity), a.contour.value_or(0)) <
               std::pair(-static_cast<int>(b.severity), b.contour.value_or(0));
    });
    return findings;
}

}  // namespace kontur
