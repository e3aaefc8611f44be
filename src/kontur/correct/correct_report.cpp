// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/correct_report.h"

#include <fmt/format.h>

#include <cmath>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"

namespace kontur {
namespace {

constexpr double kLeastReach = 0.25, kMostReach = 4;

}  // namespace

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

void check_options(const CorrectOptions& options) {
    if (!(options.reach >= kLeastReach && options.reach <= kMostReach))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the reach is {}, not between {} and {}", options.reach, kLeastReach, kMostReach));
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
