// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/image_report.h"
#include "kontur/labels/painted_object.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Where an object is fitted: voxels of an image.
struct FillGround {
    const Grid& image;
    const IndexBox& range;  ///< of its indices
};

struct ObjectFitOptions {
    double smoothing_voxels = 0;  ///< of the painted outlines (SectionContourOptions)
    UseImage use_image = UseImage::automatic;
    std::optional<double> max_memory_mb{};
};

/// What the outlines of an object make between the slices.
struct ObjectFit {
    Mask mask;  ///< on the range
    ImplicitFunction function;
    ImageReport image{};
};

/// By the outlines alone. `smoothing` is that of a fit; unset: its own. Throws what `segment` throws.
ObjectFit fit_outlines(const PaintedObject& object, const FillGround& ground, std::optional<double> smoothing,
                       const ObjectFitOptions& options, const Work& work);

/// With the image, if there is one and it helps: through all outlines, since there it is learnt what the border looks like.
/// Else by the outlines alone, as smoothly as they are unsteady.
ObjectFit fit_object(const PaintedObject& object, const FillGround& ground, const Image* image,
                     const ObjectFitOptions& options, const Work& work);

}  // namespace kontur
