// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/time_axis.h"

#include <fmt/format.h>

#include <algorithm>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

std::size_t bytes_of(const Image& image) {
    return std::visit([](const auto& samples) { return samples.size() * sizeof(samples[0]); }, image.samples);
}

}  // namespace

TimeAxis::TimeAxis(std::shared_ptr<const Image> own, Times times, std::size_t most_bytes)
    : own_(std::move(own)), times_(std::move(times)), most_bytes_(most_bytes) {}

std::shared_ptr<const Image> TimeAxis::image(int time) {
    if (time < 0 || time >= times_.count)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("there is no time {}: the last one is time {}", time, times_.count - 1));
    if (time == times_.own) return own_;
    const std::scoped_lock lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const auto& one) { return one.first == time; });
    if (found != kept_.end()) kept_.splice(kept_.begin(), kept_, found);
    else kept_.emplace_front(time, times_.read(time));
    std::size_t bytes = 0;
    for (auto one = kept_.begin(); one != kept_.end();) {
        bytes += bytes_of(*one->second);
        one = bytes > most_bytes_ && one != kept_.begin() ? kept_.erase(one) : std::next(one);
    }
    return kept_.front().second;
}

}  // namespace kontur::viewer
