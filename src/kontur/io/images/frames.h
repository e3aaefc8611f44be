// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace kontur {

/// The frames of an image over time.
struct ImageFrames {
    std::int64_t count = 1;
    std::optional<double> step_s{};  ///< from one to the next; unset: the file does not say
};

}  // namespace kontur
