// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/expected_dice.h"

#include <algorithm>
#include <cmath>

#include "kontur/sureness/surface_evidence.h"
#include "kontur/sureness/uncertainty_model.h"

namespace kontur {
namespace {

double dice_of(double odds) { return 1 / (1 + odds); }
double odds_of(double dice) { return (1 - dice) / dice; }

}  // namespace

ExpectedDice expected_dice(const SurfaceEvidence& evidence) { return expected_dice(evidence, evidence.distances_mm); }

ExpectedDice expected_dice(const SurfaceEvidence& evidence, std::span<const double> distances_mm) {
    const SurfaceSamples& samples = evidence.samples;
    if (samples.points.empty() || !(evidence.volume_mm3 > 0)) return {};
    double sum = 0;
    for (std::size_t n = 0; n < samples.points.size(); ++n) {
        const double h = std::max(distances_mm[n] / evidence.size_mm, kLeastDistance);
        const double slope = std::clamp(samples.slopes[n], kLeastSlope, kMostSlope);
        sum += samples.areas_mm2[n] * std::pow(h, kDice.distance) * std::pow(slope, kDice.slope) * evidence.shares[n];
    }
    const double error = sum * evidence.size_mm / evidence.volume_mm3;
    const double odds_of_mm = kDice.drawing * samples.area_mm2() / (2 * evidence.volume_mm3);
    const double odds =
        std::exp(kDice.factor) * std::pow(error, kDice.power) + odds_of_mm * evidence.disagreement_mm / std::sqrt(2.0);
    return {dice_of(odds), dice_of(kDice.high * odds + odds_of_mm * evidence.hand_mm), dice_of(kDice.low * odds)};
}

std::size_t planes_to(const ExpectedDice& now, std::size_t planes_drawn, double target) {
    if (now.value >= target || !(now.value > 0)) return 0;
    const double factor = std::pow(odds_of(now.value) / odds_of(target), 1 / kGainPower);
    return static_cast<std::size_t>(std::max(1.0, std::round(static_cast<double>(planes_drawn) * (factor - 1))));
}

}  // namespace kontur
