// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "kontur/view/reslice.h"

namespace kontur::viewer {

/// What a page sees in one of its views.
struct WatchedPlane {
    std::string page, view;
    Reslice raster;
    nlohmann::json plane;  ///< as the page named it
    int time = 0;          ///< of the image
};

/// The latest plane of each page's views, as many as two pages have. Safe for concurrent use.
class WatchedPlanes {
public:
    /// In place of the one that this view of the page had.
    void set(WatchedPlane plane);
    /// The newest last.
    std::vector<WatchedPlane> all() const;

private:
    mutable std::mutex mutex_;
    std::vector<WatchedPlane> planes_;
};

}  // namespace kontur::viewer
