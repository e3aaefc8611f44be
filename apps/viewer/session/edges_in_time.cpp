// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/edges_in_time.h"

#include <algorithm>

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostTimes = 3;

}  // namespace

void EdgesInTime::set_further(int image, const std::shared_ptr<const Image>& further) {
    const std::scoped_lock lock(mutex_);
    if (further) further_[image] = further;
    else further_.erase(image);
    for (auto& [time, edges] : kept_) edges->set_further(image, further);
}

std::shared_ptr<SliceEdges> EdgesInTime::at(int time) {
    const auto image = times_.image(time);
    const std::scoped_lock lock(mutex_);
    const auto known = std::ranges::find(kept_, time, [](const auto& one) { return one.first; });
    if (known != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, known);
        return known->second;
    }
    kept_.emplace_front(time, std::make_shared<SliceEdges>(image));
    for (const auto& [number, further] : further_) kept_.front().second->set_further(number, further);
    if (kept_.size() > kMostTimes) kept_.pop_back();
    return kept_.front().second;
}

}  // namespace kontur::viewer
