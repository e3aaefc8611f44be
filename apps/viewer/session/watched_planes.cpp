// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/watched_planes.h"

#include <utility>

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostWatched = 8;  // two pages of four views

}  // namespace

void WatchedPlanes::set(WatchedPlane plane) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(planes_, [&](const WatchedPlane& old) { return old.page == plane.page && old.view == plane.view; });
    if (planes_.size() == kMostWatched) planes_.erase(planes_.begin());
    planes_.push_back(std::move(plane));
}

std::vector<WatchedPlane> WatchedPlanes::all() const {
    const std::scoped_lock lock(mutex_);
    return planes_;
}

}  // namespace kontur::viewer
