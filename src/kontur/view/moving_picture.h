// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/rgb_image.h"
#include "kontur/shape/volume.h"
#include "kontur/view/picture.h"

namespace kontur {

/// A volume over frames as a picture shows it.
struct PictureCurve {
    std::vector<double> values_ml;                     ///< of each frame; at least 1
    std::vector<std::pair<double, double>> intervals;  ///< of each, low and high; none: not known
    std::vector<std::size_t> drawn;                    ///< frames with contours, from 0
    std::size_t largest = 0, smallest = 0;             ///< frames, from 0
    std::optional<std::size_t> now{};                  ///< the frame that the picture is of
};

/// An object at one of its frames.
struct PictureMoment {
    std::string caption;
    const TriangleMesh& mesh;
    const ContourSet& contours;  ///< drawn at it; may be none
    const Image* image;          ///< may be null
};

/// What a picture of a moving object shows.
struct MovingPictureContent {
    std::vector<PictureMoment> moments;  ///< one or two, below each other
    const ContourSet& all_contours;      ///< of all moments: where the slice lies
    std::span<const Vec3> shown;         ///< mm: all frames' surfaces lie within, so that the views stay the same
    PictureCurve curve;
    Window window{};  ///< of the slices
};

/// One picture of an object that moves: for each of the moments its surface and a slice of the image with its outline, at
/// the same place and scale; the volume's curve with its interval, and figures where there are two moments. Same input, same
/// bytes. Throws as `make_picture` does, and Error(invalid_input) without a moment or a value of the curve.
RgbImage make_moving_picture(const MovingPictureContent& content, const PictureOptions& options = {}, const Work& work = {});

}  // namespace kontur
