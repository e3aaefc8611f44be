// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/section_faults.h"

#include <algorithm>
#include <utility>

namespace kontur {
namespace {

SectionFaultKind kind_of(const WrongRegion& region) {
    if (region.is_missing) return SectionFaultKind::missing;
    return region.is_island ? SectionFaultKind::island : SectionFaultKind::surplus;
}

/// At the plane's largest region that nothing explains.
SectionFault fault_of(const PlaneCheck& plane) {
    const auto first = std::ranges::find_if(plane.regions, [](const WrongRegion& r) { return !r.is_explained; });
    const WrongRegion& region = first == plane.regions.end() ? plane.regions.front() : *first;
    SectionFault fault{kind_of(region), region.position, {}, region.area_mm2 / plane.area_mm2};
    if (plane.contour) fault.contours.push_back(*plane.contour);
    return fault;
}

/// Sorts those behind `begin`, the largest share or length first.
void sort_behind(std::size_t begin, std::vector<SectionFault>& faults) {
    std::stable_sort(faults.begin() + static_cast<std::ptrdiff_t>(begin), faults.end(),
                     [](const SectionFault& a, const SectionFault& b) {
                         return std::pair(a.share, a.length_mm) > std::pair(b.share, b.length_mm);
                     });
}

}  // namespace

std::string_view name(SectionFaultKind kind) noexcept {
    switch (kind) {
        case SectionFaultKind::missing:
            return "missing";
        case SectionFaultKind::surplus:
            return "surplus";
        case SectionFaultKind::island:
            return "island";
        case SectionFaultKind::between:
            return "between";
        case SectionFaultKind::beyond:
            return "beyond";
        case SectionFaultKind::outside:
            break;
    }
    return "outside";
}

std::vector<SectionFault> faults(const SectionCheck& check) {
    std::vector<SectionFault> result;
    for (const PlaneCheck& plane : check.planes)
        if (plane.is_wrong) result.push_back(fault_of(plane));
    sort_behind(0, result);
    const std::size_t planes = result.size();
    for (const BetweenCheck& between : check.between) {
        // The way back from the other plane tells the same.
        const bool is_known =
            std::any_of(result.begin() + static_cast<std::ptrdiff_t>(planes), result.end(), [&](const SectionFault& fault) {
                return fault.contours == std::vector{between.other, between.contour};
            });
        if (between.is_wrong && !is_known)
            result.push_back({SectionFaultKind::between,
                              between.position,
                              {between.contour, between.other},
                              between.missing_share,
                              between.gap_mm});
    }
    sort_behind(planes, result);
    const std::size_t ways = result.size();
    for (const BeyondCheck& beyond : check.beyond)
        if (beyond.is_wrong)
            result.push_back({SectionFaultKind::beyond, beyond.position, {beyond.contour}, 0, beyond.length_mm});
    sort_behind(ways, result);
    if (check.is_outside_wrong)
        result.push_back({SectionFaultKind::outside, check.outside_position, {}, check.outside_share});
    return result;
}

}  // namespace kontur
