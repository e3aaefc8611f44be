// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/volumes.h"

#include "kontur/phantom/frames.h"

namespace kontur {
namespace {

constexpr Vec3 kAbdomenSpacing_mm{1.2, 1.2, 3};

Grid abdomen_grid() { return grid_around({{-198, -138, -108}, {198, 126, 100}}, kAbdomenSpacing_mm, 0); }

/// Taller, so that the turned slices still cover every body.
Grid oblique_abdomen_grid() { return oblique(grid_around({{-198, -138, -140}, {198, 126, 132}}, kAbdomenSpacing_mm, 0)); }

}  // namespace

std::vector<PhantomVolume> phantom_volumes() {
    return {
        {"abdomen", "the whole upper abdomen in axial slices of 3 mm", abdomen_grid(), phantom_bodies()},
        {"abdomen_oblique", "the same in slices turned by 20, 10 and 5 degrees", oblique_abdomen_grid(), phantom_bodies()},
        {"liver", "the liver's surroundings on the grid of its contour sets", liver_grid(), {liver(), metastasis()}},
        {"metastasis", "the metastasis's surroundings on the grid of its contour sets", metastasis_grid(), {metastasis()}}};
}

}  // namespace kontur
