// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// One of the phantom's bodies on the grid of its cases.
struct Organ {
    Body body;
    Mask truth;
    Box3 box;  ///< of the truth's voxels
};

/// Liver, kidney, metastasis and vertebra. Half the liver's resolution tells the same at an eighth of the time.
std::vector<Organ> organs();

}  // namespace kontur
