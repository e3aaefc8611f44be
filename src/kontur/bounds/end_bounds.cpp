// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/end_bounds.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/smooth_step.h"

namespace kontur {
namespace {

constexpr double kParallelCosine = 0.9945, kSlantedCosine = 0.866;  // 6 and 30 degrees
constexpr double kGapShare = 0.85;                                  // of a gap: the object ends anywhere in it
constexpr double kMostGaps = 100;                                   // no more can be told from these
constexpr double kMostHeight = 1.5;                                 // guesses
constexpr double kBeyondPoints = 1.25;
constexpr double kLedOn = 0.35;     // of the height: the object surely goes on where a region lies so far ahead
constexpr double kHitCosine = 0.9;  // planes tilted less than 26 degrees are met straight ahead
// ... or contours of other directions reach; a third of it, and the volume jumps by 7 % as one of two planes turns
constexpr double kLedByOthers = 1;
constexpr double kBeside = 0.3;                     // of their distance beside the section is taken off what these reach
constexpr double kEdge = 2;                         // heights from its outline a dome is as high as in the middle
constexpr double kNoise = 0.05, kGuessNoise = 0.3;  // of the height
constexpr double kGuess = 0.2;                      // belief in a height that is but a guess
constexpr std::size_t kRimPoints = 40;              // per outline
constexpr double kSeen = 1.3;  // heights to the border of the image that show an end; up to 1 it may lie beyond

struct PlaneBefore {
    double distance;
    double weight;  ///< 1 for a parallel one
};

std::vector<PlaneBefore> planes_before(const DrawnPlanes& planes, const Section& section, double sign) {
    std::vector<PlaneBefore> before;
    for (const Section& other : planes.sections) {
        const double cosine = dot(section.plane.normal, other.plane.normal);
        const double weight = smooth_step(kSlantedCosine, kParallelCosine, std::abs(cosine));
        const double distance = weight > 0 ? sign * other.plane.distance_to(section.plane.origin) / cosine : 0;
        if (&other != &section && distance > 0) before.push_back({distance, weight});
    }
    std::sort(before.begin(), before.end(),
              [](const PlaneBefore& a, const PlaneBefore& b) { return a.distance < b.distance; });
    return before;
}

/// How many gaps there are, each by its share of the widest one: those of planes drawn twice do not count.
double count_of(const std::vector<double>& gaps) {
    constexpr double kPower =
        1.5;  // 1 moves the volume by 2.1 % as a third plane leaves the second one, 2 as gaps become equal
    const double widest = gaps.empty() ? 0 : std::ranges::max(gaps);
    double count = 0;
    for (const double gap : gaps) count += widest > 0 ? std::pow(gap / widest, kPower) : 0;
    return std::max(count, 1.0);
}

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
          areas_(areas_without_holes(own.section)) {}

    /// Over one of the region's outlines. True if the end was needed there and its height is a guess.
    bool append(std::size_t outline, std::vector<Bound>& bounds) const {
        double deepest = 0;
        for (const Probe& probe : own_.inside)
            if (probe.outline == outline) deepest = std::max(deepest, probe.depth);
        if (deepest == 0) return false;
        const Polygon2& line = own_.section.outlines[outline];
        const EndHeight end = end_height(planes_, own_.section, sign_, std::sqrt(areas_[outline] / M_PI));
        const double height = end.height_mm;
        const double left = 1 - smooth_step(0, kLedByOthers * height, reach_of_others_);
        if (left < kLeastBelief) return false;
        const double noise = height * (end.belief * kNoise + (1 - end.belief) * kGuessNoise);
        const bool is_guess = end.belief < kGuess;
        double open = 0;  // where it is a guess, how surely nothing lies ahead, however near
        const auto add = [&](const Vec3& foot, double above, double most_mm) {
            const double seen = left * is_seen(foot, height);
            const double needed = seen * (1 - led_on(foot, height));
            if (is_guess) open = std::max(open, seen * (1 - led_on(foot, planes_.tolerance_mm)));
            if (needed > kLeastBelief)
                bounds.push_back({.position = foot + above * up_, .most_mm = most_mm, .noise_mm = faded(noise, needed)});
        };
        const double edge = std::min(deepest, kEdge * height);
        for (const Probe& probe : own_.inside) {
            if (probe.outline != outline) continue;
            const double rim = 1 - std::min(probe.depth / edge, 1.0);
            add(own_.section.plane.from_uv(probe.at), height * std::sqrt(1 - rim * rim), 0);
        }
        // The outline itself must not be carried on, neither straight nor flaring.
        for (std::size_t i = 0; i < line.size(); i += std::max<std::size_t>(1, line.size() / kRimPoints))
            add(own_.section.plane.from_uv(line[i]), height, -height / 4);
        return open > 0.5;
    }

private:
    /// How surely the image goes on far enough to have shown an end over a place of the region.
    double is_seen(const Vec3& foot, double height) const {
        return planes_.image ? smooth_step(1, kSeen, planes_.image->border_ahead_mm(foot, up_) / height) : 1;
    }

    /// How far contours of other directions lead on beyond the plane: less, the less they are tilted against it and the
    /// farther they lie beside the region.
    double reach_of_others() const {
        const Plane& plane = own_.section.plane;
        double most = 0;
        const auto consider = [&](const Vec3& p, double slant) {
            const double ahead = sign_ * plane.distance_to(p) * slant;
            if (ahead <= most) return;
            const Point2 at = plane.to_uv(p);
            most = std::max(most, ahead - (own_.search.contains(at) ? 0 : kBeside * own_.search.clearance(at)));
        };
        for (const Contour& contour : planes_.set.contours) {
            const double slant = norm(cross(plane.normal, contour.plane.normal));
            for (const Vec3& p : contour.points) consider(p, slant);
        }
        return most;
    }

    /// How surely the object goes on over a place of the region: 1 where a region of another plane lies ahead.
    double led_on(const Vec3& place, double height) const {
        double most = 0;
        const auto shown_at = [&](double ahead, double beside) {
            most = std::max(most, smooth_step(0, kLedOn * height, ahead) * (1 - smooth_step(0.5, 1, beside / ahead)));
        };
        for (const DrawnRegion& other : regions_) {
            if (most == 1) break;
            if (&other == &own_ || dot(other.ball.center - place, up_) <= -other.ball.radius) continue;
            const Plane& plane = other.section.plane;
            if (const double cosine = dot(up_, plane.normal); std::abs(cosine) > kHitCosine) {
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
};

}  // namespace

EndHeight end_height(const DrawnPlanes& planes, const Section& section, double sign, double guess_mm) {
    double thickness = 0;
    std::vector<double> gaps, counted;
    const std::vector<PlaneBefore> before = planes_before(planes, section, sign);
    for (const PlaneBefore& plane : before) {
        gaps.push_back(std::max(plane.distance - thickness, 0.0));
        const double believed = plane.weight * gaps.back();
        thickness += believed;
        counted.push_back(believed);
    }
    double mean_gap = guess_mm, gap_before = 0;
    for (std::size_t k = before.size(); k-- > 0;) {
        const double gap = gaps[k], weight = before[k].weight;
        const double belief = gap > 0 ? weight * gap / (gap + gap_before) : 0;
        mean_gap = belief * gap + (1 - belief) * mean_gap;
        gap_before = weight * gap + (1 - weight) * gap_before;
    }
    const double count = count_of(counted);
    // One gap tells as much as it is wide beside the object; several that are alike tell it by being alike.
    const double odds = std::pow(thickness / guess_mm, 2 / count) * std::exp2(std::min(count, kMostGaps) - 1);
    const double belief = odds / (1 + odds);
    const double rest = guess_mm * guess_mm / (guess_mm + thickness / 2);
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
