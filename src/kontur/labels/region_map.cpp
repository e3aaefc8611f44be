// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/region_map.h"

#include <map>
#include <utility>

namespace kontur {

RegionMap::RegionMap(std::span<const BoxedMask> objects) : regions_{{}} {
    box_ = objects.front().box;
    for (const BoxedMask& object : objects) box_ = box_around(box_, object.box);
    for (int axis = 0; axis < 3; ++axis) --box_.low[axis], ++box_.high[axis];
    const Index3 size = box_.size();
    of_voxels_.resize(static_cast<std::size_t>(size.i * size.j * size.k));
    for (std::size_t object = 0; object < objects.size(); ++object) add(objects[object], object);
}

void RegionMap::add(const BoxedMask& mask, std::size_t object) {
    std::map<Region, Region> with;  // the region that an object makes of another
    std::size_t n = 0;
    for (std::int64_t k = mask.box.low.k; k <= mask.box.high.k; ++k)
        for (std::int64_t j = mask.box.low.j; j <= mask.box.high.j; ++j)
            for (std::int64_t i = mask.box.low.i; i <= mask.box.high.i; ++i) {
                if (!mask.mask.values[n++]) continue;
                Region& region = of_voxels_[place({i, j, k})];
                const auto [found, is_new] = with.try_emplace(region, static_cast<Region>(regions_.size()));
                if (is_new) {
                    std::vector<std::size_t> members = regions_[region];
                    members.push_back(object);
                    regions_.push_back(std::move(members));
                }
                region = found->second;
            }
}

}  // namespace kontur
