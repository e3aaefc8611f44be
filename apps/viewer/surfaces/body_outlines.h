// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "kontur/base/work.h"
#include "kontur/shape/volume.h"

namespace kontur::viewer {

/// The patient's outlines in an image, each looked for once: that takes seconds, and the image stays the same. Safe for
/// concurrent use.
class BodyOutlines {
public:
    /// As `body_outline`; who asks for one that somebody looks for waits.
    std::shared_ptr<const Mask> at(const Image& image, const std::optional<double>& threshold, const Work& work);

private:
    std::mutex mutex_;
    std::map<std::optional<double>, std::shared_ptr<const Mask>> known_;
};

}  // namespace kontur::viewer
