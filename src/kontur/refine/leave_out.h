// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/function/implicit_function.h"
#include "kontur/refine/movement.h"
#include "kontur/refine/refine.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A point of a drawn contour and how far the surface through the contours of the other planes passes from it.
struct HeldOut {
    Vec3 position;       ///< mm
    double distance_mm;  ///< to the nearest contour of the other planes
    double without_mm;   ///< error of what the contours alone make, along the normal, positive outwards
    double with_mm;      ///< and of what the image makes of it
    std::size_t plane = 0;
};

/// Measured on the drawn contours themselves: how far off the surface between them is, without the image and with it.
class HeldOutErrors {
public:
    /// `held_out`: points at least a voxel from the other planes' contours; at least 10.
    /// `hand_mm`: standard deviation of the drawn lines themselves, which no surface and no image can know.
    HeldOutErrors(std::vector<HeldOut> held_out, const Beliefs& beliefs, double limit_mm, double voxel_mm, double hand_mm,
                  std::size_t planes, std::int64_t intensities);

    double without_mm() const { return without_mm_; }  ///< means of the absolute errors
    double with_mm() const { return with_mm_; }
    std::size_t planes() const { return planes_; }
    std::int64_t intensities() const { return intensities_; }  ///< read from the image
    /// The error is lower with the image, by more than chance makes it in so few planes.
    bool image_helps() const;
    Beliefs beliefs() const;

private:
    double image_sd(const MovingPoint& point) const;
    bool helps_planes() const;

    std::vector<HeldOut> held_out_;
    Beliefs beliefs_;
    double voxel_mm_, hand_mm_;
    std::size_t planes_;
    std::int64_t intensities_;
    double without_mm_ = 0, with_mm_ = 0;
    double median_without_ = 0, median_with_ = 0, median_distance_ = 0;
};

/// Leaves out one drawn plane after another, at most 10 of them, fits the others, lets the image move that surface, and
/// looks how far it passes from the contours left out. Nothing where fewer than 4 planes were drawn or too little of them is
/// left. What contours disagree by where they cross is their own error and not counted.
std::optional<HeldOutErrors> leave_planes_out(const Drawing& drawing, const Image& image, const FitContours& fit,
                                              const Work& work);

}  // namespace kontur
