// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kontur {

// Constants of the band, of the expected Dice and of the volume's interval. bench/annotators/uncertainty_fit.py fitted them
// to 1198 drawings of 39 smooth bodies by simulated annotators, bench/annotators/organ_band.py those that say so to drawings
// of real structures; both of the half `tune` (docs/accuracy/sureness.md). Lengths are in sizes of the surface
// (SurfaceEvidence::size_mm), so that results turn and scale with the drawing.

/// A surface is never said to be nearer than this to a line, and |grad f| is taken within these limits.
inline constexpr double kLeastDistance = 0.003, kLeastSlope = 0.3, kMostSlope = 2;

/// half width = exp(factor) * h^distance * |grad f|^slope * (mean h)^mean_distance * (area^1.5 / volume)^shape * n^planes
/// with n = SurfaceEvidence::whole_planes(). Factor, distance and planes are of real structures: parts that were missed
/// begin near lines, too, and few planes miss more of them than mean h tells. The band holds .894, .915, .926 of the border
/// by 3 or 4, 5 to 7, 10 planes (tune). At the same mean width: half the distance .866, .899, .923; twice .920, .934, .935,
/// with far places too wide; half of planes .875, .918, .941; twice .924, .908, .900.
struct BandModel {
    double factor, distance, slope, mean_distance, shape, planes;
};
inline constexpr BandModel kBand{-1.62, 0.58, -0.51, 0.52, 0.81, -0.70};

/// The lines of a whole plane, in square roots of the surface's area: a great circle of a ball is 1.77. Fitted with
/// half of it the band holds as much, with twice .01 less by 3 or 4 planes.
inline constexpr double kWholeSection = 1;

/// (1 - Dice) / Dice = exp(factor) * E^power with E = mean(h^distance * |grad f|^slope) * area / volume, and what contours
/// disagree by on top. The ratio's true value lies within [low, high] times that in 90 % of all cases. What parallel
/// contours tell of the hand is added at the worse end alone. Factor, low and high are of real structures, of which the
/// interval holds .95, .92, 1.00 (as above). With half of low .96, .95, 1.00; twice .68, .63, .70; half of high .62, .75,
/// .85; twice .98, .96, 1.00.
struct DiceModel {
    double factor, power, distance, slope, drawing, low, high;
};
inline constexpr DiceModel kDice{-2.83, 1.68, 0.97, -0.71, 0.5, 0.4, 2.6};

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
