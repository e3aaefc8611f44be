// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/fit/fit.h"
#include "kontur/fit/prepare.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/volume.h"
#include "kontur/sureness/image_shares.h"

namespace kontur {

/// Fits f to a part of the contours; coarsely will do.
using FitContours = std::function<ImplicitFunction(const ContourSet& part)>;

/// Whether the image is asked where the surface runs between the contours.
enum class UseImage {
    off,        ///< the contours alone
    automatic,  ///< where it is shown, at contours left out, that the image helps
};
std::string_view name(UseImage use) noexcept;

struct ImageOptions {
    FitOptions fit;             ///< as the contours were fitted
    bool gate = true;           ///< false: the image is used without having shown that it helps
    std::size_t samples = 450;  ///< points of the surface at which it is asked
};

/// What became of the image.
enum class ImageVerdict {
    none,     ///< there was none, or it was not to be used
    labels,   ///< it is a mask or a label map: what it shows is no image's border; not used
    unknown,  ///< too few planes were drawn to tell whether it helps; not used
    no_help,  ///< it does not help at contours left out; not used
    astray,   ///< it helps there, but the surface that follows it leaves where it was asked; not used
    used,
};
std::string_view name(ImageVerdict verdict) noexcept;

struct ImageReport {
    ImageVerdict verdict = ImageVerdict::none;
    std::size_t planes_left_out = 0;
    double error_without_mm = 0;  ///< mean distance of contours left out from the surface through the others ...
    double error_with_mm = 0;     ///< ... and the same with the image
    bool displaced = false;       ///< ... or from a surface that was displaced there on purpose (displace.h)
    bool walked = false;          ///< the surface is drawn to that of a random walk on the image's voxels (voxel_walk.h)
    double weight = 0;            ///< how far what the image shows is followed, 0 to 1: the walk, or else the movement
    double wrong_without = 0;  ///< cells of planes left out on the wrong side, over those inside: by the contours alone ...
    double wrong_with = 0;     ///< ... and by such a walk
    double largest_move_mm = 0;       ///< of the surface, at the points asked
    std::int64_t intensities = 0;     ///< read from the image
    double on_contours_mm = 0;        ///< the largest change of f at some 500 of the drawn points
    std::vector<AskedPoint> asked{};  ///< where it was asked, and how much surer it made the surface there

    /// Of the error without the image, measured where planes were left out or displaced; 1 where it is not used.
    double share_left() const;
};

/// One sentence for people.
std::string sentence(const ImageReport& report);

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
ImageFit follow_image(const Drawing& drawing, const PreparedContours& prepared, const FittedFunction& fitted,
                      const Image& image, const FitContours& fit_contours, const ImageOptions& options,
                      const Work& work = {});

}  // namespace kontur
