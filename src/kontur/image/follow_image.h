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
    bool gate = true;           ///< false: the image is used without having shown that it helps
    std::size_t samples = 450;  ///< points of the surface at which it is asked
};

struct ImageFit {
    FittedFunction fitted;  ///< as it came, where the image is not used
    ImageReport report;
};

/// Moves the surface between the contours to where the image shows the border, and leaves it where they were drawn. What the
/// border looks like is learnt along the contours (appearance.h); how far the contours alone are off and how far the image
/// is, is measured by leaving out one drawn plane after another (leave_out.h), or, where that shows no help, by displacing
/// the surface at each (displace.h); where the image does not help, nothing is changed. f stays one function: the moved
/// points are more data with noise, beside those of the fit, of one more solve. An image that says nothing changes nothing.
/// `fit_contours` fits a part of the drawing. The same bytes for any number of threads, on one type of processor. Throws
/// Error as `solve` does, Error(invalid_input) as `check_image` does.
ImageFit follow_image(const FittedDrawing& fit, const Image& image, const FitContours& fit_contours,
                      const ImageOptions& options, const Work& work = {});

}  // namespace kontur
