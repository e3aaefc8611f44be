// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "kontur/measure/section_check.h"

namespace kontur {
namespace {

std::string at(const Vec3& p) { return fmt::format("at ({:.1f}, {:.1f}, {:.1f}) mm", p.x, p.y, p.z); }

std::string percent(double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0); }

std::string plane_name(const PlaneCheck& plane) {
    return plane.contour ? fmt::format("the plane of contour {}", *plane.contour + 1)
                         : fmt::format("the empty plane {}", at(plane.plane.origin));
}

/// The largest region that nothing explains.
const WrongRegion& worst_region(const PlaneCheck& plane) {
    const auto first =
        std::find_if(plane.regions.begin(), plane.regions.end(), [](const WrongRegion& r) { return !r.is_explained; });
    return first == plane.regions.end() ? plane.regions.front() : *first;
}

const char* fault(const WrongRegion& region) {
    if (region.is_missing) return "missing";
    return region.is_island ? "an island that was not drawn" : "not drawn";
}

std::string planes_sentence(const SectionCheck& check) {
    const PlaneCheck& worst =
        *std::max_element(check.planes.begin(), check.planes.end(), [](const PlaneCheck& a, const PlaneCheck& b) {
            return std::pair(a.is_wrong, a.wrong_share) < std::pair(b.is_wrong, b.wrong_share);
        });
    const WrongRegion& region = worst_region(worst);
    const std::size_t count = check.wrong_planes();
    const std::string where =
        count == 1 ? fmt::format("in {}", plane_name(worst))
                   : fmt::format("in {} of {} drawn planes, most in {},", count, check.planes.size(), plane_name(worst));
    return fmt::format("{} the result is not as drawn: {} of the section is wrong, and {} of it is {} {}", where,
                       percent(worst.wrong_share), percent(region.area_mm2 / worst.area_mm2), fault(region),
                       at(region.position));
}

template <class Check, class Worse>
const Check* worst_of(const std::vector<Check>& checks, const Worse& badness) {
    const Check* worst = nullptr;
    for (const Check& one : checks)
        if (one.is_wrong && (!worst || badness(one) > badness(*worst))) worst = &one;
    return worst;
}

}  // namespace

std::vector<std::string> sentences(const SectionCheck& check) {
    std::vector<std::string> result;
    if (check.wrong_planes() > 0) result.push_back(planes_sentence(check));
    if (const auto* worst = worst_of(check.between, [](const BetweenCheck& b) { return b.missing_share; }))
        result.push_back(fmt::format(
            "contours {} and {} show the object {:.3g} mm apart, and {} of it is missing between them {}; a contour there "
            "would carry it on",
            worst->contour + 1, worst->other + 1, worst->gap_mm, percent(worst->missing_share), at(worst->position)));
    if (const auto* worst = worst_of(check.beyond, [](const BeyondCheck& b) { return b.length_mm / b.gap_mm; })) {
        const std::string gaps =
            fmt::format("{:.1f} times the distance between its planes", worst->length_mm / worst->gap_mm);
        result.push_back(fmt::format("beyond contour {} the object goes on for {:.3g} mm, {}; {}", worst->contour + 1,
                                     worst->length_mm, gaps,
                                     worst->is_flat ? "it was to end flat" : "an empty plane would say where it ends"));
    }
    if (check.is_outside_wrong)
        result.push_back(
            fmt::format("{} of the object lies far outside of what was drawn, {}; an empty plane would say where "
                        "it ends",
                        percent(check.outside_share), at(check.outside_position)));
    return result;
}

}  // namespace kontur
