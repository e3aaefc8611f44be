// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// Volumes of one file or series that follow each other.
struct Times {
    int count = 1;
    int own = 0;                                                   ///< the one that was opened
    std::function<std::shared_ptr<const Image>(int time)> read{};  ///< another one; may throw as `read_image`
    std::optional<double> step_s{};                                ///< from one to the next, where the file says so
    std::optional<double> cycle_frames{};                          ///< after which the motion repeats, likewise
};

/// The volumes of an image in time, read when they are asked for. Those used last are kept. Safe for concurrent use.
class TimeAxis {
public:
    TimeAxis(std::shared_ptr<const Image> own, Times times, std::size_t most_bytes = std::size_t{1} << 30);

    int count() const { return times_.count; }
    int own() const { return times_.own; }
    /// Throws Error(invalid_input) for a time that there is not.
    std::shared_ptr<const Image> image(int time);

private:
    const std::shared_ptr<const Image> own_;
    const Times times_;
    const std::size_t most_bytes_;
    std::mutex mutex_;  ///< held while reading: who asks for a time that is being read waits for it
    std::list<std::pair<int, std::shared_ptr<const Image>>> kept_;  ///< the last used one first
};

}  // namespace kontur::viewer
