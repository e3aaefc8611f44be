// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "kontur/base/error.h"

namespace kontur {

/// A file has several frames, and none was chosen: Error(unsupported) that says how many there are.
class FrameChoiceError : public Error {
public:
    FrameChoiceError(std::string_view message, std::int64_t frames)
        : Error(ErrorKind::unsupported, message), frames_(frames) {}

    /// They count from 0.
    std::int64_t frames() const noexcept { return frames_; }

private:
    std::int64_t frames_;
};

}  // namespace kontur
