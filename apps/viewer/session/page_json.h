// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "viewer/model/model.h"

namespace kontur::viewer {

/// Objects as pages are told of them: with what they show and no project need store. For one message, which must not take
/// seconds where a project holds millions of points: beyond some 100,000 contours count as crossing themselves nowhere.
class PageJson {
public:
    nlohmann::json operator()(const Structure& structure);
    nlohmann::json operator()(const DrawnContour& contour);

private:
    std::size_t points_ = 0;
};

}  // namespace kontur::viewer
