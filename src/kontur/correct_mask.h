// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/correct_report.h"
#include "kontur/correct/corrections.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/volume.h"

namespace kontur {

class SurfaceChange;

/// A corrected mask, and for each of its voxels a CorrectedVoxel: how it came to be what it is.
struct CorrectedMask {
    Mask mask;
    std::vector<std::uint8_t> origin;
    CorrectReport report;
    /// Of the mask's function f0, without what slices, the image and loose pieces say voxel by voxel.
    std::shared_ptr<const SurfaceChange> change{};
};

/// Corrects a mask by what was drawn in some planes. The change is carried on to both sides of a plane over about half the
/// radius of the largest ball in the mask, and to nothing beyond kReachLengths times that: all other voxels stay. Without
/// corrections, or with some that repeat the mask, the mask stays as it is. The same bytes for any number of threads. Throws
/// Error(invalid_input) for options out of their range, an empty mask and corrections that cannot be understood.
CorrectedMask correct(const Mask& mask, const Corrections& corrections, const CorrectOptions& options = {},
                      const Work& work = {});
/// The same; an image decides how far corrections are carried, up to kFartherWithImage times as far (image_reach.h).
CorrectedMask correct(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options = {},
                      const Work& work = {});
/// With a surface found before, of this mask: for several corrections one after the other.
CorrectedMask correct(const Mask& mask, const ExistingSurface& surface, const Corrections& corrections,
                      const CorrectOptions& options = {}, const Work& work = {});

}  // namespace kontur
