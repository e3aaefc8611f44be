// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/measure/section_check.h"
#include "kontur/pipeline.h"
#include "kontur/segment_report.h"
#include "kontur/shape/volume.h"
#include "kontur/sureness/surface_evidence.h"

namespace kontur {

/// What the stages of one run of `segment` have made.
struct StageResults {
    const Drawing& drawing;
    const StageOptions& options;
    const PreparedContours& prepared;
    const FittedFunction& fitted;
    const ImageReport& image;
    const SurfaceLattice& surface;
    const Mask& mask;
    const SectionCheck& check;
};

/// The report of a run, with a sentence on each choice and doubt; `seconds` and `estimated_memory_mb` are left to `segment`.
SegmentReport describe(const StageResults& results, const SegmentOptions& options, const Work& work);

/// What the report says of the drawing's own error.
EvidenceFacts evidence_facts(const SegmentReport& report, const Grid& grid);

}  // namespace kontur
