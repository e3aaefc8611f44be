// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kontur {

// Constants of the band, of the expected Dice and of the volume's interval, all fitted by
// bench/annotators/uncertainty_fit.py to 1198 drawings of 39 structures by simulated annotators, the half `tune`
// (docs/accuracy/sureness.md). Lengths are in sizes of the surface (SurfaceEvidence::size_mm), so
// that results turn and scale with the drawing.

/// A surface is never said to be nearer than this to a line, and |grad f| is taken within these limits.
inline constexpr double kLeastDistance = 0.003, kLeastSlope = 0.3, kMostSlope = 2;

/// half width = exp(factor) * h^distance * |grad f|^slope * (mean h)^mean_distance * (area^1.5 / volume)^shape
struct BandModel {
    double factor, distance, slope, mean_distance, shape;
};
inline constexpr BandModel kBand{-1.76, 1.10, -0.51, 0.52, 0.81};

/// (1 - Dice) / Dice = exp(factor) * E^power with E = mean(h^distance * |grad f|^slope) * area / volume, and the drawing's
/// own error on top. The ratio's true value lies within [low, high] times that in 90 % of all cases.
struct DiceModel {
    double factor, power, distance, slope, drawing, low, high;
};
inline constexpr DiceModel kDice{-2.87, 1.68, 0.97, -0.71, 0.5, 0.52, 2.05};

/// 1 - Dice falls with this power of the number of planes.
inline constexpr double kGainPower = 1.42;

/// True volume over that of the surface, less 1, lies within [-low, high] times (1 - Dice) / Dice in 90 % of all cases.
struct VolumeModel {
    double low, high;
};
inline constexpr VolumeModel kVolume{1.0, 2.32};

/// Of a Gaussian: 90 % lie within so many standard deviations.
inline constexpr double kNinety = 1.645;

}  // namespace kontur
