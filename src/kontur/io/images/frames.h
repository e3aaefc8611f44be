// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kontur {

struct DicomContent;

/// The frames of an image over time.
struct ImageFrames {
    std::int64_t count = 1;
    std::optional<double> step_s{};                 ///< from one to the next; unset: the file does not say, or it varies
    std::optional<double> cycle_s{};                ///< after which the motion repeats; unset: the file does not say
    bool are_volumes = false;                       ///< of a DICOM series
    std::vector<std::string> series_uids{};         ///< of DICOM series, one for each frame; else empty
    std::optional<double> frames_per_cycle{};       ///< where the file says so without times, as per cents of a breath do
    std::vector<std::filesystem::path> files{};     ///< of a folder with a file for each frame; else empty
    std::shared_ptr<const DicomContent> headers{};  ///< of DICOM files, so that they are read once only; else null
    std::string order{};  ///< of frames in files or series of their own: a sentence on it; else empty

    /// The cycle in frames; unset, too, where it would end before the last frame.
    std::optional<double> cycle_frames() const {
        const bool has_times = step_s && cycle_s && *step_s > 0;
        if (!has_times && !frames_per_cycle) return std::nullopt;
        const double frames = has_times ? *cycle_s / *step_s : *frames_per_cycle;
        return frames > static_cast<double>(count - 1) ? std::optional(frames) : std::nullopt;
    }
};

}  // namespace kontur
