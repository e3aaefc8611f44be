// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace kontur {

/// The frames of an image over time.
struct ImageFrames {
    std::int64_t count = 1;
    std::optional<double> step_s{};   ///< from one to the next; unset: the file does not say, or it varies
    std::optional<double> cycle_s{};  ///< after which the motion repeats; unset: the file does not say
    bool are_volumes = false;         ///< of a DICOM series

    /// The cycle in frames; unset, too, where it would end before the last frame.
    std::optional<double> cycle_frames() const {
        if (!step_s || !cycle_s || !(*step_s > 0)) return std::nullopt;
        const double frames = *cycle_s / *step_s;
        return frames > static_cast<double>(count - 1) ? std::optional(frames) : std::nullopt;
    }
};

}  // namespace kontur
