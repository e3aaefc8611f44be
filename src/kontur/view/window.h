// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/shape/volume.h"

namespace kontur {

/// The intensities that a screen shows from black to white: `center` +- `width` / 2.
struct Window {
    double center = 40;
    double width = 350;

    friend bool operator==(const Window&, const Window&) = default;
};

/// CT soft tissue (level 40, width 350) when the values look like Hounsfield units, that is, when they reach from air
/// (-200 or lower) to soft tissue; else from the 1st to the 99th percentile. Never of zero width.
Window suggest_window(const Image& image);

/// 0 (black) to 1 (white); NaN is black.
double brightness(double value, const Window& window);

}  // namespace kontur
