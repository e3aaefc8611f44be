// SPDX-License-Identifier: Apache-2.0
#include "kontur/evidence.h"

#include "kontur/describe.h"

namespace kontur {

SurfaceEvidence gather_evidence(const Segmentation& made, const ContourSet& contours, const Work& work) {
    return gather_evidence(made.samples, contours, evidence_facts(made.report, made.mask.grid), work);
}

}  // namespace kontur
