// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/section_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/measure/plane_look.h"
#include "kontur/measure/ways.h"
#include "kontur/measure/wrong_regions.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

// Of the drawing's diameter: how deep a wrong place is not to be an unsteady hand's. So much may contours disagree by.
constexpr double kDeep = 0.0045;

/// The planes in which something closed is drawn, then those given as empty.
std::vector<PlaneLook> looks_of(const std::vector<Section>& sections, const ContourSet& set, const DrawingSize& size,
                                const Work& work) {
    std::vector<std::optional<PlaneLook>> looks_of_sections(sections.size());
    parallel_for(static_cast<std::int64_t>(sections.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n) {
            const auto s = static_cast<std::size_t>(n);
            looks_of_sections[s].emplace(sections[s], set, size);
        }
    });
    std::vector<PlaneLook> looks;
    double area = 0;
    for (std::optional<PlaneLook>& look : looks_of_sections)
        if (look->area_mm2() > 0) {
            area += look->area_mm2();
            looks.push_back(std::move(*look));
        }
    if (looks.empty()) return looks;
    const double mean = area / static_cast<double>(looks.size());
    for (const Plane& plane : set.empty_planes) looks.emplace_back(plane, mean, size);
    return looks;
}

PlaneCheck check_plane(const PlaneLook& look, std::vector<WrongRegion> regions) {
    constexpr double kMostWrong = 0.02, kMostIsland = 0.005;  // of a section
    PlaneCheck check{look.plane(), look.contour(), look.area_mm2(), 0, 0, std::move(regions), false};
    bool any_lost = false;
    for (const WrongRegion& region : check.regions) {
        if (region.is_explained) continue;
        check.wrong_share += region.area_mm2 / check.area_mm2;
        if (region.is_island) check.island_share += region.area_mm2 / check.area_mm2;
        any_lost = any_lost || region.is_lost;
    }
    check.is_wrong = check.wrong_share > kMostWrong || check.island_share > kMostIsland || any_lost;
    return check;
}

}  // namespace

std::size_t SectionCheck::wrong_planes() const {
    return static_cast<std::size_t>(
        std::count_if(planes.begin(), planes.end(), [](const PlaneCheck& p) { return p.is_wrong; }));
}

double SectionCheck::largest_wrong_share() const {
    double largest = 0;
    for (const PlaneCheck& plane : planes) largest = std::max(largest, plane.wrong_share);
    return largest;
}

SectionCheck check_sections(const ContourSet& contours, const PlaceValues& values, const PlaceValues& exact,
                            const Work& work) {
    SectionCheck check;
    const Ball3 ball = smallest_ball(contours);
    if (!(ball.radius > 0)) return check;
    const DrawingSize size{ball, kDeep * ball.diameter()};
    const std::vector<Section> sections = sections_of(contours, kSamePlane * ball.diameter());
    std::vector<PlaneLook> looks = looks_of(sections, contours, size, work);
    if (looks.empty()) return check;
    look(looks, values, exact, size, work);
    const std::vector<std::vector<Contradiction>> contradicted = contradictions(looks, contours);
    const OtherPlanes others(looks, size.tolerance_mm);
    std::vector<std::vector<WrongRegion>> regions(looks.size());
    parallel_for(static_cast<std::int64_t>(looks.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t n = begin; n < end; ++n) {
            const auto p = static_cast<std::size_t>(n);
            regions[p] = wrong_regions(looks[p], contradicted[p], others, size.tolerance_mm);
        }
    });
    for (std::size_t p = 0; p < looks.size(); ++p) check.planes.push_back(check_plane(looks[p], std::move(regions[p])));
    check_ways(looks, contours, size, values, check);
    return check;
}

}  // namespace kontur
