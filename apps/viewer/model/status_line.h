// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "kontur/base/stop.h"
#include "kontur/base/work.h"
#include "viewer/model/stage_words.h"

namespace kontur::viewer {

/// Tells the pages' status lines what is being done, as long as it lives.
class StatusLine {
public:
    using Tell = std::function<void(const std::string& text, std::optional<double> done)>;

    StatusLine(Tell tell, std::string what) : tell_(std::move(tell)), what_(std::move(what)) {}
    ~StatusLine() { tell_("", std::nullopt); }
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    /// News by the tenth: more would only cost the page time.
    Work work(const StopToken& stop) const {
        const auto tell = [this, last = std::make_shared<std::pair<std::string_view, int>>()](std::string_view stage,
                                                                                              double done) {
            const std::pair<std::string_view, int> now{stage, static_cast<int>(10 * done)};
            if (*last == now) return;
            *last = now;
            tell_(fmt::format("{}: {}", what_, words_of_stage(stage)), now.second / 10.0);
        };
        return {.callback = tell, .stop = stop};
    }

private:
    const Tell tell_;
    const std::string what_;
};

}  // namespace kontur::viewer
