// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/pages.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "viewer/model/model_json.h"

namespace kontur::viewer {

using nlohmann::json;

std::string notice_event(std::string_view level, const std::string& text) {
    return to_text({{"event", "notice"}, {"level", std::string(level)}, {"text", text}});
}

void Pages::on_event(Listener listener) {
    const std::scoped_lock lock(mutex_);
    listener_ = std::move(listener);
}

void Pages::tell(const json& event) const {
    const std::scoped_lock lock(mutex_);
    if (listener_) listener_(to_text(event));
}

void Pages::notice(std::string_view level, const std::string& text) const {
    const std::scoped_lock lock(mutex_);
    if (listener_) listener_(notice_event(level, text));
}

void Pages::status(const std::string& text, std::optional<double> fraction) const {
    tell({{"event", "status"}, {"text", text}, {"fraction", fraction ? json(*fraction) : json(nullptr)}});
}

}  // namespace kontur::viewer
