// SPDX-License-Identifier: Apache-2.0
#include "kontur/sampling/plane_groups.h"

#include <algorithm>

#include "kontur/drawing/drawn_planes.h"
#include "kontur/shape/contour_nesting.h"

namespace kontur {
namespace {

ContourSet with_contours(const ContourSet& set, const PlaneGroup& group, bool of_group) {
    ContourSet part = set;
    part.contours.clear();
    for (std::size_t c = 0; c < set.contours.size(); ++c)
        if ((std::find(group.begin(), group.end(), c) != group.end()) == of_group) part.contours.push_back(set.contours[c]);
    return part;
}

}  // namespace

std::vector<PlaneGroup> contours_by_plane(const ContourSet& set) {
    const std::vector<std::size_t> plane = shared_planes(set.contours, kSamePlane * diameter_mm(set));
    std::vector<PlaneGroup> groups;
    std::vector<std::size_t> first;
    for (std::size_t c = 0; c < plane.size(); ++c) {
        const auto at = static_cast<std::size_t>(std::find(first.begin(), first.end(), plane[c]) - first.begin());
        if (at == first.size()) {
            first.push_back(plane[c]);
            groups.emplace_back();
        }
        groups[at].push_back(c);
    }
    return groups;
}

std::vector<PlaneGroup> at_most(std::size_t most, const std::vector<PlaneGroup>& groups) {
    if (groups.size() <= most) return groups;
    std::vector<PlaneGroup> some;
    for (std::size_t n = 0; n < most; ++n) some.push_back(groups[n * (groups.size() - 1) / (most - 1)]);
    return some;
}

ContourSet only(const ContourSet& set, const PlaneGroup& group) { return with_contours(set, group, true); }
ContourSet without(const ContourSet& set, const PlaneGroup& group) { return with_contours(set, group, false); }

}  // namespace kontur
