// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/end_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"

namespace kontur {
namespace {

// Power of the thickness over the radius in the odds that all of an object was drawn, by one gap. Half of it costs three
// slices in the middle of organs .038 of Dice; twice gains .018, and four low discs are 4 times too thick instead of 2.2.
constexpr double kOdds = 4;
// Of a gap: the object ends anywhere in it. All of it costs 55 organ drawings .0009 (one .009) and 35 by hand .0003.
constexpr double kGapShare = 0.85;
// Guesses. Without a limit the same lose .0002 (one .010) and .003 (one .106).
constexpr double kMostHeight = 1.5;
constexpr double kNoGap = 1e300;  // mm
constexpr double kBeyondPoints = 1.25;
// Of the height: the object surely goes on where a region lies so far ahead. Half and twice change one of 90 organ drawings
// (35 by hand), by .0004.
constexpr double kLedOn = 0.35;
constexpr double kGuessNoise = 0.3;  // of the height
// Heights from its outline a dome is as high as in the middle. Everywhere lower: six discs have 91 ml for 94 (right: 90), a
// stack with a speck far ahead is over a quarter larger than without.
constexpr double kEdge = 2;
constexpr double kGuess = 0.2;  // belief in a height that is but a guess
// Per outline. 24: 63 organ drawings lose .00007, one of them .003, and a ring with a wall of 3 mm grows by 5 %.
constexpr std::size_t kRimPoints = 40;
constexpr double kSeen = 1.3;  // heights to the border of the image that show an end; up to 1 it may lie beyond

/// The gaps between the planes before a section, the nearest first: those of planes that are tilted against it count less.
class Gaps {
public:
    Gaps(const DrawnPlanes& planes, const Section& section, double sign) {
        std::vector<PlaneBefore> before;
        for (const Section& other : planes.sections) {
            const double cosine = dot(section.plane.normal, other.plane.normal);
            const double weight = 1 - crossing(section.plane.normal, other.plane.normal);
            const double distance = weight > 0 ? sign * other.plane.distance_to(section.plane.origin) / cosine : 0;
            if (&other != &section && distance > 0) before.push_back({distance, weight});
        }
        std::ranges::sort(before, {}, &PlaneBefore::distance_mm);
        for (const auto& [distance_mm, weight] : before) {
            gaps_.push_back({std::max(distance_mm - thickness_mm_, 0.0), weight});
            thickness_mm_ += weight * gaps_.back().distance_mm;
        }
    }

    double thickness_mm() const { return thickness_mm_; }

    /// From the nearest to the farthest, each believed by what it is of itself and the one before it. Without any:
    /// `otherwise`.
    double mean_mm(double otherwise) const {
        double mean = otherwise, gap_before = 0;
        for (std::size_t k = gaps_.size(); k-- > 0;) {
            const auto [gap, weight] = gaps_[k];
            const double belief = gap > 0 ? weight * gap / (gap + gap_before) : 0;
            mean = belief * gap + (1 - belief) * mean;
            gap_before = weight * gap + (1 - weight) * gap_before;
        }
        return mean;
    }

    /// How many there are, each by its share of the widest one: those of planes drawn twice do not count.
    double count() const {
        // 1 moves the volume by 2.1 % as a third plane leaves the second one, 2 as gaps become equal.
        constexpr double kPower = 1.5;
        double widest = 0, count = 0;
        for (const auto& [gap, weight] : gaps_) widest = std::max(widest, weight * gap);
        for (const auto& [gap, weight] : gaps_) count += widest > 0 ? std::pow(weight * gap / widest, kPower) : 0;
        return std::max(count, 1.0);
    }

private:
    struct PlaneBefore {
        double distance_mm;
        double weight;  ///< 1 for a parallel one
    };

    std::vector<PlaneBefore> gaps_;
    double thickness_mm_ = 0;
};

/// How far single points lie beyond a plane.
double reach_of_points(const ContourSet& set, const Plane& plane, double sign) {
    double reach = 0;
    for (const SurfacePoint& p : set.surface) reach = std::max(reach, sign * plane.distance_to(p.position));
    for (const Vec3& p : set.interior) reach = std::max(reach, sign * plane.distance_to(p));
    return reach;
}

class End {
public:
    End(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, const DrawnRegion& own, double sign)
        : planes_(planes),
          regions_(regions),
          own_(own),
          sign_(sign),
          up_(sign * own.section.plane.normal),
          reach_of_others_(reach_of_others()),
          areas_(areas_without_holes(own.section)) {
        const double gap = Gaps(planes, own.section, sign).mean_mm(kNoGap);
        for (const DrawnRegion& other : regions) belongs_.push_back(&other == &own ? 0 : belongs(other, gap));
    }

    /// Over one of the region's outlines. True if most of it has nothing ahead and its height is a guess.
    bool append(std::size_t outline, std::vector<Bound>& bounds) const {
        double deepest = 0;
        for (const Probe& probe : own_.inside)
            if (probe.outline == outline) deepest = std::max(deepest, probe.depth);
        if (deepest == 0) return false;
        const Polygon2& line = own_.section.outlines[outline];
        const EndHeight end = end_height(planes_, own_.section, sign_, std::sqrt(areas_[outline] / M_PI));
        const double height = end.height_mm;
        // A third of the height, and the volume jumps by 7 % as one of two planes turns. Never: 63 drawings lose .003.
        const double left = 1 - smooth_step(0, height, reach_of_others_);
        if (left < kLeastBelief) return false;
        const double noise = height * (end.belief * kSureNoise + (1 - end.belief) * kGuessNoise);
        const bool is_guess = end.belief < kGuess;
        const auto add = [&](const Vec3& foot, double above, double most_mm) {
            const double needed = left * is_seen(foot, height) * (1 - led_on(foot, height));
            if (needed > kLeastBelief)
                bounds.push_back({.position = foot + above * up_, .most_mm = most_mm, .noise_mm = faded(noise, needed)});
        };
        const double edge = std::min(deepest, kEdge * height);
        double open = 0, count = 0;  // over which part nothing lies ahead, however near
        for (const Probe& probe : own_.inside) {
            if (probe.outline != outline) continue;
            const double rim = 1 - std::min(probe.depth / edge, 1.0);
            const Vec3 foot = own_.section.plane.from_uv(probe.at);
            add(foot, height * std::sqrt(1 - rim * rim), 0);
            if (!is_guess) continue;
            open += left * is_seen(foot, height) * (1 - led_on(foot, planes_.tolerance_mm));
            ++count;
        }
        // The outline itself must not be carried on, neither straight nor flaring.
        for_each_step(line, kRimPoints, [&](const Point2& p) { add(own_.section.plane.from_uv(p), height, -height / 4); });
        return open > 0.5 * count;
    }

private:
    /// How surely the image goes on far enough to have shown an end over a place of the region.
    double is_seen(const Vec3& foot, double height) const {
        return planes_.image ? smooth_step(1, kSeen, planes_.image->border_ahead_mm(foot, up_) / height) : 1;
    }

    /// How far contours of other directions lead on beyond the plane: less, the less they are tilted against it.
    double reach_of_others() const {
        const Plane& plane = own_.section.plane;
        double most = 0;
        for (const Contour& contour : planes_.set.contours) {
            const double slant = norm(cross(plane.normal, contour.plane.normal));
            for (const Vec3& p : contour.points) most = std::max(most, sign_ * plane.distance_to(p) * slant);
        }
        return most;
    }

    /// How surely a region is of the same object: one that is far off beside its size, and twice as far beside the gaps
    /// between the sections before both as rings of a tube, is a speck. What one contour shows against all others is not
    /// followed.
    double belongs(const DrawnRegion& other, double gap_mm) const {
        const Vec3 way = other.ball.center - own_.ball.center;
        const double back = dot(way, other.section.plane.normal) < 0 ? -1 : 1;
        const double gap = std::min(gap_mm, Gaps(planes_, other.section, -back).mean_mm(kNoGap));
        const double ahead = std::max(dot(way, up_), 0.0), radius = std::min(own_.radius_mm, other.radius_mm);
        return 1 - smooth_step(kFar, kTooFar, ahead / std::max(radius, 1 / kNoGap)) *
                       smooth_step(2 * kUneven, 2 * kTooUneven, ahead / gap);
    }

    /// How surely the object goes on over a place of the region: 1 where a region of another plane lies ahead.
    double led_on(const Vec3& place, double height) const {
        double most = 0;
        for (std::size_t r = 0; r < regions_.size() && most < 1; ++r) {
            const DrawnRegion& other = regions_[r];
            const auto shown_at = [&](double ahead, double beside) {
                most = std::max(
                    most, belongs_[r] * smooth_step(0, kLedOn * height, ahead) * (1 - smooth_step(0.5, 1, beside / ahead)));
            };
            if (belongs_[r] == 0 || dot(other.ball.center - place, up_) <= -other.ball.radius) continue;
            const Plane& plane = other.section.plane;
            if (const double cosine = dot(up_, plane.normal); crossing(up_, plane.normal) < 1) {
                const double ahead = -plane.distance_to(place) / cosine;
                if (ahead <= 0) continue;
                const Point2 at = plane.to_uv(place + ahead * up_);
                shown_at(ahead, other.search.contains(at) ? 0 : other.search.clearance(at));
                continue;
            }
            for (const Vec3& shown : other.places.all()) {
                const double ahead = dot(shown - place, up_);
                if (ahead > 0) shown_at(ahead, norm(shown - place - ahead * up_));
            }
        }
        return most;
    }

    const DrawnPlanes& planes_;
    const std::vector<DrawnRegion>& regions_;
    const DrawnRegion& own_;
    double sign_;
    Vec3 up_;
    double reach_of_others_;
    std::vector<double> areas_;
    std::vector<double> belongs_;  ///< how surely each region is of the same object
};

}  // namespace

EndHeight end_height(const DrawnPlanes& planes, const Section& section, double sign, double guess_mm) {
    const Gaps gaps(planes, section, sign);
    const double thickness = gaps.thickness_mm(), mean_gap = gaps.mean_mm(guess_mm), count = gaps.count();
    // One gap tells as much as it is wide beside the object; several that are alike tell it by being alike, each pair of
    // them.
    const double odds = std::pow(thickness / guess_mm, kOdds / count) * std::exp2(count * (count - 1) / 2);
    const double belief = 1 / (1 + 1 / odds);
    // Half of the thickness: the volume jumps by 2.1 % as a third plane leaves the second one; all of it: two slices of
    // organs gain nothing.
    const double rest = guess_mm * guess_mm / (guess_mm + 0.75 * thickness);
    const double between = mean_gap > 0 ? std::pow(kGapShare * mean_gap, belief) * std::pow(rest, 1 - belief) : rest;
    const double height = std::min(between, kMostHeight * guess_mm);
    return {std::max(height, kBeyondPoints * reach_of_points(planes.set, section.plane, sign)), belief};
}

std::vector<Bound> end_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                              double sign, bool& is_guess) {
    const End end(planes, regions, regions[region], sign);
    std::vector<Bound> bounds;
    is_guess = false;
    for (std::size_t o = 0; o < regions[region].section.outlines.size(); ++o) is_guess = end.append(o, bounds) || is_guess;
    return bounds;
}

}  // namespace kontur
