// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/told.h"

#include <nlohmann/json.hpp>

#include "viewer/edits/contour_edits.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostCheckedPoints = 100'000;  ///< for crossings, at some microseconds each

}  // namespace

nlohmann::json Told::operator()(const Structure& structure) { return to_json(structure); }

nlohmann::json Told::operator()(const DrawnContour& contour) {
    points_ += contour.points.size();
    nlohmann::json told = to_json(contour);
    told["self_crossings"] = points_ <= kMostCheckedPoints ? to_json(self_crossings(contour)) : nlohmann::json::array();
    return told;
}

}  // namespace kontur::viewer
