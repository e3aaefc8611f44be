// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/sureness/expected_dice.h"

namespace kontur {

struct SurfaceEvidence;

/// How sure a fitted surface is. Below `kLeastPlanes` different planes nothing is known: `is_known` is false and all figures
/// are 0. What no contour touches is not in the surface and in none of these figures.
struct SurfaceUncertainty {
    bool is_known = false;
    std::size_t planes = 0;                                       ///< different ones that were drawn in
    double half_width_median_mm = 0, half_width_p90_mm = 0;       ///< of the 90 % band, over the surface's area
    double farthest_mm = 0;                                       ///< of the surface from any drawn line ...
    Vec3 farthest_position{};                                     ///< ... and where
    double volume_ml = 0, volume_low_ml = 0, volume_high_ml = 0;  ///< the true volume lies between the latter two in 90 %
    ExpectedDice dice;
    std::size_t planes_to_95 = 0, planes_to_98 = 0;  ///< planes still to draw until that Dice is expected
};

SurfaceUncertainty surface_uncertainty(const SurfaceEvidence& evidence);

/// Half the width in mm of the band around the fitted surface that holds the true surface with 90 %, at the samples. It
/// follows from the distance h to the nearest drawn line, |grad f|, h's mean, the shape's difference from a ball, and how
/// many planes were drawn. An image that was used narrows it (image_shares.h). The drawing's own error adds in squares: half
/// a voxel, the residual, and the disagreement of contours where they cross, or what parallel ones tell of the hand. Empty
/// below `kLeastPlanes`.
std::vector<double> half_widths_mm(const SurfaceEvidence& evidence);

/// The same at any points on or near the surface, such as a mesh's, with the mean of |grad f|: a k-d tree query each.
std::vector<double> half_widths_mm(const SurfaceEvidence& evidence, const std::vector<Vec3>& points, const Work& work = {});

/// "expected Dice 0.97 (0.95 to 0.98), volume 98 ml (92 to 105); about 3 more planes to 0.98", or that it is not known.
std::string sentence(const SurfaceUncertainty& uncertainty);

/// A word where the volume's interval is so wide that its upper end is three times its lower one; else none.
std::optional<std::string> doubt(const SurfaceUncertainty& uncertainty);

}  // namespace kontur
