// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/phantom/bodies.h"
#include "kontur/shape/volume.h"

namespace kontur {

struct PhantomOptions {
    std::uint64_t seed = 1;
    double noise_hu = 14;  ///< standard deviation; neighbouring voxels are correlated as after reconstruction
};

/// A CT in Hounsfield units (int16), portal venous phase, of the phantom's abdomen on any grid: air, skin, fat, muscle,
/// ribs, spine, lung bases, stomach, bowel, spleen, pancreas, vessels, and the exact bodies. Edges are blurred over about
/// one voxel. The same bytes for any number of threads. Throws Error(invalid_input) for a noise that is not >= 0.
Image make_phantom_image(const Grid& grid, const PhantomOptions& options = {}, const Work& work = {});

/// The voxels whose centres lie inside the body.
Mask make_truth_mask(const Body& body, const Grid& grid, const Work& work = {});

}  // namespace kontur
