// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/ways.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "kontur/measure/bent_ways.h"

namespace kontur {
namespace {

constexpr std::size_t kPlaces = 100;  // of each section, from which ways lead on
constexpr double kNone = std::numeric_limits<double>::infinity();

/// A way from a place of a section along the plane's normal to the next plane; infinitely long where there is none.
struct Way {
    Vec3 from, direction;
    double length_mm = kNone;
    std::size_t to = 0;

    Vec3 at(double part) const { return from + part * length_mm * direction; }
    std::array<Vec3, kQuarters.size()> quarters() const { return {at(kQuarters[0]), at(kQuarters[1]), at(kQuarters[2])}; }
};

std::vector<Way> ways_from(std::span<const PlaneLook> looks, std::size_t own, double sign) {
    constexpr double kLeastCosine = 0.5;  // planes that stand steeper are not the next ones
    std::vector<Way> ways;
    const Vec3 direction = sign * looks[own].plane().normal;
    for (const Vec3& from : looks[own].filled_places(kPlaces)) {
        Way& way = ways.emplace_back(Way{from, direction});
        for (std::size_t other = 0; other < looks.size(); ++other) {
            const Plane& plane = looks[other].plane();
            const double cosine = dot(direction, plane.normal);
            if (other == own || std::abs(cosine) < kLeastCosine) continue;
            const double length = -plane.distance_to(from) / cosine;
            if (length > 1e-6 && length < way.length_mm) way.length_mm = length, way.to = other;
        }
    }
    return ways;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Questions about f, collected to be answered at once.
class Questions {
public:
    std::size_t ask(const Vec3& place) {
        places_.push_back(place);
        return places_.size() - 1;
    }
    void answer(const PlaceValues& values) {
        values_.resize(places_.size());
        if (!places_.empty()) values(places_, values_);
    }
    bool is_inside(std::size_t question) const { return values_[question] > 0; }
    const Vec3& place(std::size_t question) const { return places_[question]; }

private:
    std::vector<Vec3> places_;
    std::vector<double> values_;
};

class Between {
public:
    Between(std::span<const PlaneLook> looks, const ContourSet& set) : looks_(looks), set_(set) {}

    /// Ways on which both planes show the object; such as are most of a section's are looked at.
    void ask(std::size_t own, const std::vector<Way>& ways, Questions& questions) {
        constexpr std::size_t kFewest = 5;
        std::map<std::size_t, std::vector<const Way*>> ways_by_outline;
        for (const Way& way : ways)
            if (way.length_mm < kNone && looks_[way.to].contains(looks_[way.to].plane().to_uv(way.at(1))))
                ways_by_outline[way.to].push_back(&way);
        for (const auto& [to, shared] : ways_by_outline) {
            if (shared.size() < kFewest || 2 * shared.size() <= ways.size()) continue;
            Pair& pair = add_pair(own, to, *looks_[own].contour(), *looks_[to].contour(), shared.size());
            std::vector<double> lengths;
            for (const Way* way : shared) {
                lengths.push_back(way->length_mm);
                if (is_known_empty(way->quarters(), way->length_mm, way->direction, own, to)) continue;
                std::array<std::size_t, kQuarters.size()>& probes = pair.probes.emplace_back();
                for (std::size_t q = 0; q < kQuarters.size(); ++q) probes[q] = questions.ask(way->at(kQuarters[q]));
            }
            pair.gap_mm = median(std::move(lengths));
        }
    }

    /// Those along a bend, where no straight ones lead from the one plane to the other.
    void ask(const BentWays& bent, Questions& questions) {
        if (std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
                return std::minmax({pair.own, pair.to}) == std::minmax({bent.own, bent.to});
            }))
            return;
        Pair& pair = add_pair(bent.own, bent.to, bent.contour, bent.other, bent.places.size());
        pair.gap_mm = bent.length_mm;
        for (const auto& places : bent.places) {
            if (is_known_empty(places, bent.length_mm, bent.direction, bent.own, bent.to)) continue;
            std::array<std::size_t, kQuarters.size()>& probes = pair.probes.emplace_back();
            for (std::size_t q = 0; q < kQuarters.size(); ++q) probes[q] = questions.ask(places[q]);
        }
    }

    void answer(const Questions& questions, SectionCheck& check) const {
        constexpr double kMostMissing = 0.2;
        for (const Pair& pair : pairs_) {
            std::size_t missing = 0;
            std::optional<Vec3> place;
            for (const auto& probes : pair.probes) {
                const bool leaves =
                    std::any_of(probes.begin(), probes.end(), [&](std::size_t q) { return !questions.is_inside(q); });
                missing += leaves;
                if (leaves && !place) place = questions.place(probes[kQuarters.size() / 2]);
            }
            if (!place) continue;
            const double share = static_cast<double>(missing) / static_cast<double>(pair.ways);
            check.between.push_back({pair.contour, pair.other, share, pair.gap_mm, *place, share > kMostMissing});
        }
    }

private:
    struct Pair {
        std::size_t own, to, contour, other, ways;
        double gap_mm;
        std::vector<std::array<std::size_t, kQuarters.size()>> probes;
    };

    Pair& add_pair(std::size_t own, std::size_t to, std::size_t contour, std::size_t other, std::size_t ways) {
        return pairs_.emplace_back(Pair{own, to, contour, other, ways, 0, {}});
    }

    /// A third plane, or an exterior point, within half of the way shows nothing there.
    bool is_known_empty(std::span<const Vec3> places, double length_mm, const Vec3& direction, std::size_t own,
                        std::size_t to) const {
        constexpr double kNear = 0.5, kLeastSine = 0.312;  // a plane along the way, or steep across it
        for (const Vec3& place : places) {
            for (const Vec3& click : set_.exterior)
                if (distance(click, place) < kNear * length_mm) return true;
            for (std::size_t other = 0; other < looks_.size(); ++other) {
                const Plane& plane = looks_[other].plane();
                if (other == own || other == to) continue;
                const bool is_across = norm(cross(plane.normal, direction)) < kLeastSine;
                if (is_across && !lies_between(plane, places)) continue;
                if (std::abs(plane.distance_to(place)) >= kNear * length_mm) continue;
                const Point2 at = plane.to_uv(place);
                if (!looks_[other].contains(at) && !is_silent(looks_[other], at, length_mm)) return true;
            }
        }
        return false;
    }

    /// Whether a way crosses a plane: never on the way to the next plane, but rings of one tube may have others between
    /// them.
    static bool lies_between(const Plane& plane, std::span<const Vec3> places) {
        const Vec3 start = 2 * places.front() - places[1], end = 2 * places.back() - places[places.size() - 2];
        return plane.distance_to(start) * plane.distance_to(end) < 0;
    }

    /// A plane says nothing far from its own lines.
    static bool is_silent(const PlaneLook& look, const Point2& at, double gap_mm) {
        if (!look.section()) return false;
        return look.clearance(at) > std::max(look.extent_mm(), gap_mm);
    }

    std::span<const PlaneLook> looks_;
    const ContourSet& set_;
    std::vector<Pair> pairs_;
};

class Beyond {
public:
    Beyond(std::span<const PlaneLook> looks, const ContourSet& set) : looks_(looks), set_(set) {}

    /// Ways that no plane ends, of a plane behind most of which another one lies.
    void ask(std::size_t own, const std::vector<Way>& ahead, const std::vector<Way>& behind, Questions& questions) {
        constexpr std::size_t kSteps = 32;
        constexpr double kRange = 6;  // gaps
        std::vector<const Way*> free;
        std::vector<double> back;
        for (const Way& way : ahead)
            if (way.length_mm == kNone) free.push_back(&way);
        for (const Way& way : behind)
            if (way.length_mm < kNone) back.push_back(way.length_mm);
        if (free.empty() || back.empty() || 2 * free.size() < ahead.size() || 2 * back.size() < behind.size()) return;
        Last& last = lasts_.emplace_back(Last{own, free.size(), median(std::move(back)), 0, {}});
        const Vec3& direction = free.front()->direction;
        last.gap_mm = std::max(last.gap_mm, reach(looks_[own].plane().origin, direction));
        last.step_mm = kRange * last.gap_mm / kSteps;
        const std::size_t stride = free.size() / (kPlaces / 2) + 1;
        last.ways = 0;
        for (std::size_t n = 0; n < free.size(); n += stride, ++last.ways)
            for (std::size_t step = 0; step < kSteps; ++step)
                last.probes.push_back(
                    questions.ask(free[n]->from + (static_cast<double>(step) + 0.5) * last.step_mm * direction));
    }

    void answer(const Questions& questions, SectionCheck& check) const {
        constexpr double kMostGaps = 1.5, kMostOfFlat = 0.5;
        for (const Last& last : lasts_) {
            std::size_t inside = 0, farthest = 0;
            double farthest_mm = 0;
            for (const std::size_t q : last.probes) {
                if (!questions.is_inside(q)) continue;
                ++inside;
                const double off = std::abs(looks_[last.own].plane().distance_to(questions.place(q)));
                if (off > farthest_mm) farthest_mm = off, farthest = q;
            }
            if (inside == 0) continue;
            const double length = last.step_mm * static_cast<double>(inside) / static_cast<double>(last.ways);
            const bool is_flat = ends_flat(*looks_[last.own].section());
            check.beyond.push_back({*looks_[last.own].contour(), length, last.gap_mm, is_flat, questions.place(farthest),
                                    length > (is_flat ? kMostOfFlat : kMostGaps) * last.gap_mm});
        }
    }

private:
    struct Last {
        std::size_t own, ways;
        double gap_mm, step_mm;
        std::vector<std::size_t> probes;
    };

    /// How far what was drawn reaches beyond a plane.
    double reach(const Vec3& from, const Vec3& direction) const {
        double farthest = 0;
        const auto take = [&](const Vec3& p) { farthest = std::max(farthest, dot(direction, p - from)); };
        for (const Contour& contour : set_.contours) std::for_each(contour.points.begin(), contour.points.end(), take);
        std::for_each(set_.interior.begin(), set_.interior.end(), take);
        for (const SurfacePoint& p : set_.surface) take(p.position);
        return farthest;
    }

    bool ends_flat(const Section& section) const {
        return std::any_of(section.contours.begin(), section.contours.end(),
                           [&](std::size_t c) { return set_.contours[c].end == ContourEnd::flat; });
    }

    std::span<const PlaneLook> looks_;
    const ContourSet& set_;
    std::vector<Last> lasts_;
};

/// Calls visit(place, whether it lies far outside of the ball) for a lattice of places.
template <class Visit>
void for_each_around(const Ball3& ball, double step_mm, const Visit& visit) {
    constexpr double kReach = 1.6, kFar = 1.1;  // radii
    const int count = static_cast<int>(kReach * ball.radius / step_mm);
    for (int k = -count; k <= count; ++k)
        for (int j = -count; j <= count; ++j)
            for (int i = -count; i <= count; ++i) {
                const Vec3 off = step_mm * Vec3{i + 0.37, j + 0.41, k + 0.33};
                if (norm(off) < kReach * ball.radius) visit(ball.center + off, norm(off) > kFar * ball.radius);
            }
}

/// Looks coarsely first whether anything lies far outside.
void check_outside(const Ball3& ball, const PlaceValues& values, SectionCheck& check) {
    constexpr double kCoarse = 0.2, kFine = 0.1;  // radii
    constexpr double kMostOutside = 0.05;
    Questions coarse;
    for_each_around(ball, kCoarse * ball.radius, [&](const Vec3& place, bool is_far) {
        if (is_far) coarse.ask(place);
    });
    coarse.answer(values);
    std::size_t n = 0;
    bool any = false;
    for_each_around(ball, kCoarse * ball.radius, [&](const Vec3&, bool is_far) {
        if (is_far) any = coarse.is_inside(n++) || any;
    });
    if (!any) return;
    Questions fine;
    for_each_around(ball, kFine * ball.radius, [&](const Vec3& place, bool) { fine.ask(place); });
    fine.answer(values);
    std::size_t all = 0, outside = 0;
    Vec3 farthest = ball.center;
    n = 0;
    for_each_around(ball, kFine * ball.radius, [&](const Vec3& place, bool is_far) {
        if (!fine.is_inside(n++)) return;
        ++all;
        if (!is_far) return;
        ++outside;
        if (distance(place, ball.center) > distance(farthest, ball.center)) farthest = place;
    });
    if (outside == 0) return;
    check.outside_share = static_cast<double>(outside) / static_cast<double>(all);
    check.outside_position = farthest;
    check.is_outside_wrong = check.outside_share > kMostOutside;
}

}  // namespace

void check_ways(std::span<const PlaneLook> looks, const ContourSet& set, const DrawingSize& size, const PlaceValues& values,
                SectionCheck& check) {
    Between between(looks, set);
    Beyond beyond(looks, set);
    Questions questions;
    for (std::size_t own = 0; own < looks.size(); ++own) {
        if (!looks[own].section()) continue;
        const std::vector<Way> ahead = ways_from(looks, own, 1), behind = ways_from(looks, own, -1);
        between.ask(own, ahead, questions);
        between.ask(own, behind, questions);
        beyond.ask(own, ahead, behind, questions);
        beyond.ask(own, behind, ahead, questions);
    }
    for (const BentWays& bent : bent_ways(looks)) between.ask(bent, questions);
    questions.answer(values);
    between.answer(questions, check);
    beyond.answer(questions, check);
    check_outside(size.ball, values, check);
}

}  // namespace kontur
