// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/phantom/cases.h"

namespace kontur {

/// How a liver of many contours is drawn.
struct DenseLiver {
    std::size_t points = 25000;  ///< of all contours together
    bool orthogonal = false;  ///< in planes across all three axes, which contradict each other where hands drew them; else
                              ///< in axial planes
    bool by_hand = false;
};

/// A liver cut by more planes the more points there are: about 90 parallel ones for 25,000 points, which at 1.3 mm from
/// point to point are as many as the liver's surface carries; for more points the liver is enlarged instead. For
/// measuring how time and memory grow. Throws Error(invalid_input) for fewer than 100 points.
PhantomCase dense_liver_case(const DenseLiver& options);

}  // namespace kontur
