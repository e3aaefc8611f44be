// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/section_faults.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace kontur::viewer {

std::vector<SurfaceFault> surface_faults(const SectionCheck& check, const std::vector<Id>& ids) {
    constexpr int kMost = 10;
    std::map<SectionFaultKind, int> counts;
    std::vector<SurfaceFault> found;
    for (const SectionFault& fault : faults(check)) {
        // Where a structure moves, sections without an id stand for contours.
        if (std::ranges::any_of(fault.contours, [&](std::size_t n) { return ids.at(n) == 0; })) continue;
        if (++counts[fault.kind] > kMost) continue;
        SurfaceFault& place = found.emplace_back(SurfaceFault{fault.kind, fault.position, {}, fault.share, fault.length_mm});
        for (const std::size_t contour : fault.contours) place.contours.push_back(ids.at(contour));
    }
    return found;
}

nlohmann::json to_json(const std::vector<SurfaceFault>& faults) {
    nlohmann::json list = nlohmann::json::array();
    for (const SurfaceFault& fault : faults)
        list.push_back({{"kind", std::string(name(fault.kind))},
                        {"at", to_json(fault.at)},
                        {"contours", fault.contours},
                        {"share", fault.share},
                        {"length_mm", fault.length_mm}});
    return list;
}

}  // namespace kontur::viewer
