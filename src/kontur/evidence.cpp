// SPDX-License-Identifier: Apache-2.0
#include "kontur/evidence.h"

#include "kontur/describe.h"

namespace kontur {

SurfaceEvidence gather_evidence(const Segmentation& segmentation, const ContourSet& contours, const Work& work) {
    return gather_evidence(segmentation.samples, contours, evidence_facts(segmentation.report, segmentation.mask.grid),
                           work);
}

}  // namespace kontur
