// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "viewer/model/model_json.h"
#include "viewer/session/session.h"

// Whether the image is asked between the contours.

namespace kontur::viewer {

std::shared_ptr<const Image> Session::image_to_ask() const {
    return shows_borders_ && project_.state().use_image ? image_ : nullptr;
}

nlohmann::json Session::use_image() const { return shows_borders_ ? nlohmann::json(project_.state().use_image) : nullptr; }

nlohmann::json Session::set_image(const Members& m) {
    const bool before = project_.state().use_image, after = m.flag("use");
    if (before == after) return nlohmann::json::object();
    Commit step{after ? "Use the image" : "Do not use the image", {}, {}};
    step.use_image = UseImageChange{before, after};
    commit(step);
    return nlohmann::json::object();
}

}  // namespace kontur::viewer
