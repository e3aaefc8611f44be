// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kontur/base/counted.h"
#include "kontur/correct/change.h"
#include "kontur/mask_change.h"

namespace kontur {

std::string_view name(CorrectionKind kind) noexcept {
    switch (kind) {
        case CorrectionKind::outline:
            return "outline";
        case CorrectionKind::piece:
            return "piece";
        case CorrectionKind::empty:
            return "empty";
        case CorrectionKind::confirmed:
            break;
    }
    return "confirmed";
}

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

std::string sentence(const CorrectReport& report) {
    const std::int64_t drawn = report.added_drawn + report.removed_drawn,
                       carried = report.added_carried + report.removed_carried + report.added_image + report.removed_image;
    if (drawn + carried == 0) return "nothing changed: the corrections repeat the mask";
    const double more = report.volume_ml - report.volume_before_ml;
    return fmt::format("{} changed, {} of them beside the drawn planes; {:.1f} ml {}, {:.1f} ml in all",
                       counted(static_cast<std::size_t>(drawn + carried), "voxel"), carried, std::abs(more),
                       more < 0 ? "less" : "more", report.volume_ml);
}

}  // namespace kontur
