// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/volume.h"

namespace kontur {

/// An image as what can be read at any point. Keeps a reference to it.
class Intensities {
public:
    explicit Intensities(const Image& image);

    /// Trilinear; NaN outside of the image and where it holds no number.
    double at(const Vec3& point_mm) const;
    /// The smallest spacing of the image.
    double voxel_mm() const { return voxel_mm_; }
    /// How far apart intensities along a line are read: half a voxel of the same volume, no more than the smallest spacing.
    double step_mm() const { return step_mm_; }

private:
    const Image* image_;
    Affine3 mm_to_index_;
    double voxel_mm_, step_mm_;
};

/// Whether this is a mask or a label map, or empty: at most two values, or whole numbers, most of which, where they are not
/// the background's, their neighbours have, too. Looks at some 100,000 voxels, at all only where these have one value.
bool is_label_map(const Image& image);

/// Maps intensities to [0, 1], as a straight line between the 1st and 99th percentile of some of them and, to equal shares,
/// by their ranks: so contrasts are told apart wherever they are, and any image's intensities are the same when they are
/// scaled and, mirrored, when they are inverted.
class IntensityScale {
public:
    /// Values that are not finite are left out; without any, and where all are the same, everything is 1/2.
    explicit IntensityScale(std::vector<double> values);
    double operator()(double value) const;

private:
    std::vector<double> quantiles_;
    double low_ = 0, high_ = 0;
};

}  // namespace kontur
