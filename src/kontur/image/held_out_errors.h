// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kontur/image/movement.h"
#include "kontur/sampling/rise.h"

namespace kontur {

/// One plane left out of fewer leaves too little of an object.
inline constexpr std::size_t kFewestPlanes = 3;
/// Of the drawing's diameter: from point to point of the surface through those that are left.
inline constexpr double kFoldSpacing = 0.04;

/// A point of a drawn contour and how far the surface through the contours of the other planes passes from it.
struct HeldOutPoint {
    double distance_mm;   ///< to the nearest contour of the other planes
    double without_mm;    ///< error of what the contours alone make, along the normal, positive outwards
    double with_mm;       ///< and of what the image makes of it
    double reachable_mm;  ///< as much of the error without the image as walls let it mend
    std::size_t plane = 0;

    /// How far the image moves the surface here.
    double moved_mm() const { return without_mm - with_mm; }
};

/// What was found at the contours of one plane.
struct PlaneErrors {
    std::vector<HeldOutPoint> points;
    std::int64_t intensities = 0;  ///< read from the image
};

/// Whether they have points enough, in two planes at least, to tell how far off the surface is.
bool tell_enough(std::span<const PlaneErrors> planes);

/// How much is true of the offsets that the image shows: least squares of the errors of the contours alone on them.
struct OffsetTruth {
    double products = 0, squares = 0;  ///< of the offsets with the errors, and their own; weighted sums

    void add(double error_mm, double moved_mm, double weight);
    double share() const { return squares > 0 ? products / squares : 0; }
};

/// Measured on the drawn contours themselves: how far off the surface between them is, without the image and with it.
class HeldOutErrors {
public:
    /// `planes`: that tell enough, of points at least a voxel from the other planes' contours. Larger errors count as
    /// `limit_mm`.
    HeldOutErrors(std::span<const PlaneErrors> planes, const Beliefs& beliefs, double limit_mm, double voxel_mm);

    double without_mm() const { return without_mm_; }  ///< means of the absolute errors
    double with_mm() const { return with_mm_; }
    std::size_t planes() const { return planes_; }
    std::int64_t intensities() const { return intensities_; }  ///< read from the image
    /// How far the image is followed, from 0 to 1. It rises steadily, so that small changes of a fit flip nothing. 0 where
    /// the mean error with it is not below that without it by the first of these shares, or lower in no more planes than by
    /// chance. 1 where it is below by the second share, and by a standard error over the planes.
    double weight(const Rise& enough = kHelps) const;
    static constexpr Rise kHelps{0, 0.05};
    /// The share of the mean error that the image takes away.
    double error_reduction() const { return without_mm_ > 0 ? 1 - with_mm_ / without_mm_ : 0; }
    /// How far the errors without the image exceed what an image of voxels (or cells) of this edge can tell: 0 up to a
    /// quarter of one, 1 from half of one on. Contours that hold the surface better than that need no image.
    double visibility(double edge_mm) const;
    double visibility() const { return visibility(voxel_mm_); }
    /// What is true of the image's offsets counts that much only. The result refers to nothing.
    Beliefs beliefs(double weight = 1) const;

private:
    double weight_of_planes() const;
    double error_of_share() const;
    double sure_share() const;
    double clamped(double error_mm) const;
    void add(const HeldOutPoint& point, double weight, OffsetTruth& sums) const;

    std::vector<HeldOutPoint> held_out_;
    Beliefs beliefs_;
    double limit_mm_, voxel_mm_;
    std::size_t planes_ = 0;
    std::int64_t intensities_ = 0;
    double without_mm_ = 0, with_mm_ = 0;
    double median_without_ = 0, median_distance_ = 0;
    OffsetTruth truth_;          ///< a point, on the average
    double error_of_share_ = 0;  ///< standard error of its share
};

}  // namespace kontur
