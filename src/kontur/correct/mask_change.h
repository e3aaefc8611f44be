// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/correct_report.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/correct/corrections.h"
#include "kontur/correct/existing_surface.h"

namespace kontur {

/// What corrections make of a mask, as far as it differs from before.
struct MaskChange {
    std::vector<MadeVoxel> voxels;  ///< by offset
    CorrectReport report;
    /// Of the mask's function f0, without what slices, the image and loose pieces say voxel by voxel.
    std::shared_ptr<const SurfaceChange> function;
    std::shared_ptr<const ChangeLattice> lattice;  ///< of that; null where it is 0
};

/// As `correct` does, at a cost of what the corrections reach and not of the mask's grid: for a hand that draws.
MaskChange mask_change(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options,
                       const Work& work = {});

}  // namespace kontur
