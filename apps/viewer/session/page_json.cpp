// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/page_json.h"

#include <nlohmann/json.hpp>

#include "viewer/edits/contour_edits.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostCheckedPoints = 100'000;  ///< for crossings, at some microseconds each

}  // namespace

nlohmann::json PageJson::operator()(const Structure& structure) { return to_json(structure); }

nlohmann::json PageJson::operator()(const DrawnContour& contour) {
    points_ += contour.points.size();
    nlohmann::json object = to_json(contour);
    object["self_crossings"] = points_ <= kMostCheckedPoints ? to_json(self_crossings(contour)) : nlohmann::json::array();
    return object;
}

}  // namespace kontur::viewer
