// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/bounds.h"

#include <fmt/format.h>

#include "kontur/base/parallel.h"
#include "kontur/bounds/between_bounds.h"
#include "kontur/bounds/empty_planes.h"
#include "kontur/bounds/end_bounds.h"
#include "kontur/bounds/lone_outlines.h"
#include "kontur/bounds/plane_bounds.h"
#include "kontur/bounds/wall_bounds.h"
#include "kontur/bounds/wide_gaps.h"

namespace kontur {

Bounds find_bounds(const DrawnPlanes& planes, const Work& work) {
    const std::vector<DrawnRegion> regions = drawn_regions(planes, work);
    const std::vector<TubeWay> ways = tube_ways(regions);
    struct RegionBounds {
        std::vector<Bound> bounds[5];
        bool is_guess[2] = {};
    };
    std::vector<RegionBounds> found(regions.size());
    parallel_for(static_cast<std::int64_t>(regions.size()), 1, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto r = static_cast<std::size_t>(begin); r < static_cast<std::size_t>(end); ++r) {
            found[r].bounds[0] = plane_bounds(planes, regions, r, ways);
            found[r].bounds[1] = end_bounds(planes, regions, r, 1, found[r].is_guess[0]);
            found[r].bounds[2] = end_bounds(planes, regions, r, -1, found[r].is_guess[1]);
            found[r].bounds[3] = wall_bounds(planes, regions, r, 1);
            found[r].bounds[4] = wall_bounds(planes, regions, r, -1);
        }
    });
    Bounds result;
    for (std::size_t r = 0; r < found.size(); ++r) {
        for (const std::vector<Bound>& some : found[r].bounds)
            result.bounds.insert(result.bounds.end(), some.begin(), some.end());
        if ((found[r].is_guess[0] || found[r].is_guess[1]) && result.notes.empty())
            result.notes.push_back(
                fmt::format("contour {} has no others beside it that tell how far the object goes on; the thickness of the "
                            "object there is a guess from its width",
                            regions[r].section.contours.front() + 1));
    }
    if (result.notes.empty())
        if (std::optional<std::string> note = lone_outlines_note(regions, ways)) result.notes.push_back(std::move(*note));
    if (std::optional<std::string> note = wide_gap_note(planes, regions)) result.notes.push_back(std::move(*note));
    const std::vector<Bound> between = between_bounds(regions, ways);
    result.bounds.insert(result.bounds.end(), between.begin(), between.end());
    for (const Plane& empty : planes.set.empty_planes) {
        const std::vector<Bound> some = empty_plane_bounds(planes, regions, empty);
        result.bounds.insert(result.bounds.end(), some.begin(), some.end());
    }
    return result;
}

}  // namespace kontur
