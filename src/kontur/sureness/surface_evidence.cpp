// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/surface_evidence.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/smallest_ball.h"
#include "kontur/sureness/hand_error.h"
#include "kontur/sureness/uncertainty_model.h"

namespace kontur {
namespace {

/// How large an object is: its diameter, but no more than twelve times its thickness (a ball's diameter). Organs are up to
/// ten times as long as thick; what is longer is a vessel, or many small parts far from each other.
double size_mm(const SurfaceSamples& samples, double volume_mm3) {
    constexpr double kThicknesses = 12;
    const double diameter = smallest_ball(samples.points).diameter(), area = samples.area_mm2();
    return area > 0 && volume_mm3 > 0 ? std::min(diameter, kThicknesses * 6 * volume_mm3 / area) : diameter;
}

}  // namespace

double SurfaceEvidence::whole_planes() const {
    const double whole_mm = kWholeSection * std::sqrt(samples.area_mm2());
    double planes = 0;
    for (const double length_mm : lines.lengths_mm()) planes += std::min(1.0, length_mm / whole_mm);
    return planes;
}

SurfaceEvidence gather_evidence(SurfaceSamples samples, const ContourSet& contours, const EvidenceFacts& facts,
                                const Work& work) {
    SurfaceEvidence evidence{.samples = std::move(samples), .distances_mm = {}, .lines = DrawnLines(contours)};
    evidence.distances_mm = evidence.lines.distances_to(evidence.samples.points, work);
    evidence.size_mm = size_mm(evidence.samples, facts.volume_mm3);
    evidence.image = ImageShares(facts.shares);
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
