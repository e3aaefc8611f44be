// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/intensities.h"
#include "kontur/image/offsets.h"
#include "kontur/image/walls.h"

namespace kontur {

/// What surrounds a drawing: the image, places along the contours, and the walls that they make.
struct Surroundings {
    Surroundings(const Drawing& drawing, const Image& image);

    Intensities image;
    std::vector<Vec3> points;    ///< along the contours, close together: how far a place is from them
    std::vector<Vec3> examples;  ///< fewer of them: what the border looks like
    Walls walls;
};

/// What is known of the offsets before the image is looked at, and how far it is trusted.
struct Beliefs {
    std::function<double(double distance_mm)> prior_mm;  ///< standard deviation of an offset
    /// How wrong the image is; infinite: it is not believed there; unset: not known.
    std::function<double(double distance_mm)> image_mm{};
};

/// Points of a surface and how far the image moves them.
struct Movement {
    std::vector<MovingPoint> points;
    OffsetPrior prior;
    Offsets offsets;
    std::int64_t intensities = 0;  ///< read from the image
};

inline constexpr std::size_t kLeastPoints = 10;     ///< of a surface, and of errors: fewer tell nothing
inline constexpr double kMostContourPoints = 4000;  ///< along the contours, to measure distances from them
inline constexpr double kLeastPrior = 0.08;         ///< voxels: no offset is known better than this beforehand
inline constexpr double kMostPriorSlope = 0.25;     ///< prior standard deviation over the distance from the contours
inline constexpr double kSearched = 2.5;  ///< prior standard deviations to each side: no offset beyond is considered

/// Asks the image how far the surface of f at some points of it (mm) is off. Points less than three quarters of a voxel from
/// a contour are left out; none where fewer than 10 remain.
Movement find_movement(const Surroundings& surroundings, const ImplicitFunction& function, std::span<const Vec3> points,
                       const Beliefs& beliefs, const Work& work);

}  // namespace kontur
