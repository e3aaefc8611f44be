// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/wide_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

// Of the gaps before and after. Half of it names stacks whose planes someone left out; twice is silent on two bodies 9 mm
// apart in slices of 3 mm.
constexpr double kWide = 2.5;
// Of the other gap of three slices, where nothing else tells that a plane was left out. Half names even ones; twice is
// silent on two towers of bench/hunt.py, seed 7, which a plane without a contour divides.
constexpr double kWideOfThree = 1.9;

bool overlap(const DrawnRegion& region, const Section& other) {
    return std::ranges::any_of(region.inside, [&](const Probe& probe) {
        return other.contains(other.plane.to_uv(region.section.plane.from_uv(probe.at)));
    });
}

bool any_empty_ahead(const ContourSet& set, const Plane& plane, double distance_mm) {
    return std::ranges::any_of(set.empty_planes, [&](const Plane& empty) {
        const double ahead = plane.distance_to(empty.origin);
        return are_parallel(plane, empty) && ahead > 0 && ahead < distance_mm;
    });
}

/// Whether planes that are tilted against the two show the object in the middle half of the gap.
bool any_shown_ahead(const std::vector<DrawnRegion>& regions, const Plane& plane, double distance_mm) {
    return std::ranges::any_of(regions, [&](const DrawnRegion& other) {
        return std::ranges::any_of(other.places.all(), [&](const Vec3& place) {
            return std::abs(plane.distance_to(place) / distance_mm - 0.5) < 0.25;
        });
    });
}

/// The section ahead of a region, and how many times as far away as those before and after, of which one may be missing.
struct WideGap {
    const Section* section;
    double distance_mm;
    double times;
};

std::optional<WideGap> wide_gap(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions,
                                const DrawnRegion& region) {
    const Plane& plane = region.section.plane;
    const auto before = planes.next(plane, -1), next = planes.next(plane, 1);
    if (!next) return {};
    const double sign = dot(plane.normal, next->section->plane.normal) < 0 ? -1 : 1;
    const auto after = planes.next(next->section->plane, sign);
    if (!before && !after) return {};
    const double beside = std::max(before ? before->distance_mm : 0, after ? after->distance_mm : 0);
    const double times = next->distance_mm / beside;
    if (times < (planes.sections.size() == 3 ? kWideOfThree : kWide) || !overlap(region, *next->section) ||
        any_empty_ahead(planes.set, plane, next->distance_mm) || any_shown_ahead(regions, plane, next->distance_mm))
        return {};
    return WideGap{next->section, next->distance_mm, times};
}

}  // namespace

std::optional<std::string> wide_gap_note(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions) {
    for (const DrawnRegion& region : regions)
        if (const auto gap = wide_gap(planes, regions, region))
            return fmt::format(
                "contours {} and {} lie {:.3g} mm apart, {:.1f} times as far as the planes beside them; an "
                "empty plane between them would say that they are two bodies, a contour that they "
                "are one",
                region.section.contours.front() + 1, gap->section->contours.front() + 1, gap->distance_mm, gap->times);
    return {};
}

}  // namespace kontur
