// SPDX-License-Identifier: Apache-2.0
#include "kontur/refine/surface_evidence.h"

#include "kontur/base/smallest_ball.h"
#include "kontur/refine/hand_error.h"

namespace kontur {

SurfaceEvidence gather_evidence(SurfaceSamples samples, const ContourSet& contours, const EvidenceFacts& facts,
                                const Work& work) {
    SurfaceEvidence evidence{.samples = std::move(samples), .distances_mm = {}, .lines = DrawnLines(contours)};
    evidence.distances_mm = evidence.lines.distances_to(evidence.samples.points, work);
    evidence.diameter_mm = smallest_ball(evidence.samples.points).diameter();
    evidence.image = ImageShares(facts.asked);
    for (const Vec3& p : evidence.samples.points) evidence.shares.push_back(evidence.image.at(p));
    evidence.volume_mm3 = facts.volume_mm3;
    evidence.voxel_mm = facts.voxel_mm;
    evidence.residual_mm = facts.residual_mm;
    evidence.disagreement_mm = facts.disagreement_mm;
    if (!(facts.disagreement_mm > 0)) evidence.hand_mm = parallel_hand_mm(contours);
    return evidence;
}

double trusted_disagreement_mm(const Disagreement& crossings) {
    constexpr std::size_t kLeastCrossings = 4;
    return crossings.matched < kLeastCrossings ? 0 : crossings.rms_mm;
}

}  // namespace kontur
