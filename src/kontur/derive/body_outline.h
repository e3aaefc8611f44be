// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"

namespace kontur {

/// The patient's body in an image: the largest part above a threshold, without what hangs on it by less than 8 mm, such as a
/// couch, and with all that its outline encloses on the slices. The threshold is -250 where the image reaches below -500, as
/// CT does in air, else Otsu's (1979). Throws Error(invalid_input) where nothing lies above it.
Mask body_outline(const Image& image, const std::optional<double>& threshold, const Work& work);

}  // namespace kontur
