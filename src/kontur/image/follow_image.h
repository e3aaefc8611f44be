// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/image_report.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Fits f to a part of the contours; coarsely will do.
using FitContours = std::function<ImplicitFunction(const ContourSet& part)>;

/// What was drawn, and the function through it.
struct FittedDrawing {
    const Drawing& drawing;
    const PreparedContours& prepared;
    const FittedFunction& fitted;
};

struct ImageOptions {
    FitOptions fit;             ///< as the contours were fitted
    std::size_t samples = 450;  ///< points of the surface at which it is asked
};

struct ImageFit {
    FittedFunction fitted;  ///< as it came, where the image is not used
    ImageReport report;
};

/// Moves the surface between the contours to the border that the image shows, and leaves it where they were drawn. The look
/// of the border is learnt along the contours (appearance.h). Leaving out one drawn plane after another measures how far the
/// contours alone are off, and how far the image is (leave_out.h). Where that shows no help, the surface is displaced at
/// each plane instead (displace.h). Without help nothing changes. f stays one function: one more solve has the moved points
/// as data with noise. An image that says nothing changes nothing. `fit_contours` fits a part of the drawing. The same bytes
/// for any number of threads, on one type of processor. Throws Error as `solve` does, Error(invalid_input) as `check_image`
/// does.
ImageFit follow_image(const FittedDrawing& fit, const Image& image, const FitContours& fit_contours,
                      const ImageOptions& options, const Work& work = {});

}  // namespace kontur
