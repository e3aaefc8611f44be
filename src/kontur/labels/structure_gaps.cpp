// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/structure_gaps.h"

#include <algorithm>
#include <limits>

#include "kontur/labels/filled_map.h"

namespace kontur {

std::vector<std::optional<std::size_t>> owners_of_gaps(const TouchingStructures& structures, const GapPlaces& gaps,
                                                       const MayOwn& may_own, const Work& work) {
    const std::vector<Vec3>& places_mm = gaps.places_mm;
    struct Nearest {
        std::optional<std::size_t> structure;
        double depth_mm = -std::numeric_limits<double>::infinity(), next_mm = depth_mm;
    };
    std::vector<Nearest> nearest(places_mm.size());
    for (std::size_t structure = 0; structure < structures.each.size(); ++structure) {
        std::vector<Vec3> places;
        std::vector<std::size_t> which;
        for (std::size_t n = 0; n < places_mm.size(); ++n)
            if (may_own(n, structure)) places.push_back(places_mm[n]), which.push_back(n);
        const std::vector<double> depths = depths_mm(structures.each[structure], places, work);
        for (std::size_t m = 0; m < which.size(); ++m) {
            Nearest& best = nearest[which[m]];
            if (depths[m] > best.depth_mm) best = {structure, depths[m], best.depth_mm};
            else best.next_mm = std::max(best.next_mm, depths[m]);
        }
    }
    std::vector<std::optional<std::size_t>> owners(places_mm.size());
    for (std::size_t n = 0; n < places_mm.size(); ++n)
        if (nearest[n].next_mm > -structures.reach_mm && gaps.in_union_mm[n] > -nearest[n].depth_mm)
            owners[n] = nearest[n].structure;
    return owners;
}

}  // namespace kontur
