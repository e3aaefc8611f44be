// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/held_out_errors.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Errors made on purpose, where the truth is known. The surface through all contours is displaced at one plane
/// after another, outwards and inwards. It moves by a quarter of the usual distance from contours, which is the
/// largest error ever expected. The image, taught by the other planes, says how far it has to move back. No fit
/// leaves a plane out, so this works where too few planes would be left. Nothing for fewer than 3 planes, for more
/// than 5 (leaving planes out tells more then), and where the error is less than half a voxel, the step of the
/// search.
std::optional<HeldOutErrors> displace_planes(const Drawing& drawing, const Image& image, const ImplicitFunction& function,
                                             const Work& work);

/// The share of a displacement that an image has to take back: below the first it is not followed, from the second on
/// wholly. Images that lie beside the drawing reach neither (docs/decisions/0013-few-planes.md).
inline constexpr Rise kTakenBack{0.2, 0.3};
/// And with three planes, to be followed for what leaving one of them out says: two are left then, which tell little.
inline constexpr Rise kNotDenied{0.1, 0.2};

}  // namespace kontur
