// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace kontur::viewer {

/// The event that tells pages something the user should know.
std::string notice_event(std::string_view level, const std::string& text);

/// The open pages, as far as events go. Safe for concurrent use.
class Pages {
public:
    using Listener = std::function<void(const std::string& message)>;

    /// Who passes events on, from any thread. An empty function: nobody.
    void on_event(Listener listener);

    void tell(const nlohmann::json& event) const;
    /// Something that the user should know.
    void notice(std::string_view level, const std::string& text) const;
    /// What is being done, and how much of it is done; an empty text when nothing is.
    void status(const std::string& text, std::optional<double> fraction) const;
    /// The same as a function, which must not outlive the pages.
    auto status_teller() const {
        return [this](const std::string& text, std::optional<double> fraction) { status(text, fraction); };
    }

private:
    mutable std::mutex mutex_;
    Listener listener_;
};

}  // namespace kontur::viewer
