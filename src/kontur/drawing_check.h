// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/extract/track.h"
#include "kontur/function/implicit_function.h"
#include "kontur/measure/section_check.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// check_sections for a function and what was drawn; contours are numbered as they were drawn. Its values are computed at
/// about 3,000 places for each drawn plane, which takes about a fifth of the time of a fit.
SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const Work& work = {});

/// The same for whatever answers what f is at places; `exact`, if any, where that looks wrong.
SectionCheck check_sections(const Drawing& drawing, const PlaceValues& values, const PlaceValues& exact,
                            const Work& work = {});

/// The same for a function on a grid, whose voxels answer most of the questions: a few percent of the time of a fit. What
/// the mask does not have is not there, even if f is above 0. About contours that are hardly wider than a voxel f answers.
SectionCheck check_sections(const Drawing& drawing, const ImplicitFunction& function, const SurfaceLattice& surface,
                            const Mask& mask, const Work& work = {});

}  // namespace kontur
