// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A scan of the phantom.
struct PhantomVolume {
    std::string name;
    std::string note;  ///< one sentence: what it shows
    Grid grid;
    std::vector<Body> bodies;  ///< those that it shows whole
};

/// The scans to write: "abdomen" (axis-aligned), "abdomen_oblique", "liver" (the grid of the liver's cases) and
/// "metastasis". The contour sets of phantom_case_names() lie in the same frame.
std::vector<PhantomVolume> phantom_volumes();

}  // namespace kontur
