// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "viewer/model/model_json.h"
#include "viewer/session/session_state.h"

// The calls of docs/viewer-protocol.md, one table for each file that carries some out. A call throws what its edits throw.

namespace kontur::viewer {

struct Call {
    nlohmann::json (*carry_out)(SessionState& s, const Members& arguments);
    bool needs_project = true;  ///< false: it only looks at the image, and edits and slices need not wait for it
};
using Calls = std::map<std::string, Call, std::less<>>;

Calls border_calls();
Calls contour_calls();
Calls history_calls();
Calls motion_calls();
Calls page_calls();
Calls point_calls();
Calls proposal_calls();
Calls review_calls();
Calls rule_calls();
Calls second_image_calls();
Calls structure_calls();
Calls use_image_calls();

/// All of them, by name.
const Calls& all_calls();

}  // namespace kontur::viewer
