// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"

// Whether fits follow the image between the contours.

namespace kontur::viewer {
namespace {

using nlohmann::json;

json set_image(SessionState& s, const Members& m) {
    const bool before = s.project.state().use_image, after = m.flag("use");
    if (before == after) return json::object();
    Commit step{after ? "Use the image" : "Do not use the image", {}, {}};
    step.use_image = UseImageChange{before, after};
    commit(s, step);
    return json::object();
}

}  // namespace

Calls use_image_calls() { return {{"image.set", {set_image}}}; }

std::shared_ptr<const Image> image_for_fits(const SessionState& s) {
    return s.image.shows_borders && s.project.state().use_image ? s.image.voxels : nullptr;
}

std::shared_ptr<const Image> image_for_fits_at(SessionState& s, int time) {
    return image_for_fits(s) ? s.image.times.image(time) : nullptr;
}

json use_image_json(const SessionState& s) {
    return s.image.shows_borders ? json(s.project.state().use_image) : json(nullptr);
}

}  // namespace kontur::viewer
