// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/body_outlines.h"

#include "kontur/derive/body_outline.h"

namespace kontur::viewer {

std::shared_ptr<const Mask> BodyOutlines::at(const Image& image, const std::optional<double>& threshold, const Work& work) {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<const Mask>& known = known_[threshold];
    if (!known) known = std::make_shared<const Mask>(body_outline(image, threshold, work));
    return known;
}

}  // namespace kontur::viewer
