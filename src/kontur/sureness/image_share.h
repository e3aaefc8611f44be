// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/geometry.h"

namespace kontur {

/// A place of the surface at which the image was asked.
struct ImageShare {
    Vec3 position;     ///< mm, where the image moved it to
    double share = 1;  ///< of the error without the image that it leaves: standard deviations of the offset, 0 to 1
};

}  // namespace kontur
