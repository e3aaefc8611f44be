// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct_mask.h"

#include <utility>

#include "kontur/correct/mask_change.h"

namespace kontur {

CorrectedMask correct(const Mask& mask, const Corrections& corrections, const CorrectOptions& options, const Work& work) {
    check_options(options);
    return correct(mask, ExistingSurface(mask, work), corrections, options, work);
}

CorrectedMask correct(const Mask& mask, const ExistingSurface& surface, const Corrections& corrections,
                      const CorrectOptions& options, const Work& work) {
    return correct(MaskToCorrect{mask, surface}, corrections, options, work);
}

CorrectedMask correct(const MaskToCorrect& what, const Corrections& corrections, const CorrectOptions& options,
                      const Work& work) {
    MaskChange change = mask_change(what, corrections, options, work);
    CorrectedMask corrected{what.mask, what.mask.values, std::move(change.report), std::move(change.function)};
    for (std::uint8_t& origin : corrected.origin) origin = origin != 0;
    for (const MadeVoxel& voxel : change.voxels) {
        corrected.mask.values[voxel.offset] = voxel.is_inside();
        corrected.origin[voxel.offset] = static_cast<std::uint8_t>(voxel.how);
    }
    return corrected;
}

}  // namespace kontur
