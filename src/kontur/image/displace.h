// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kontur/base/work.h"
#include "kontur/drawing/drawing.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/held_out_errors.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Errors made on purpose, where it is known what is right. The surface through all contours is displaced at the contours of
/// one plane after another, outwards and inwards, by a quarter of how far its places between the contours usually are from
/// them (the most that is ever expected of their errors); the image, taught by the contours of the other planes, is asked
/// how far it has to move. No surface is fitted without a plane for this, so it tells of images where what is left of a few
/// planes shows too little of the object. Nothing for fewer than 3 planes, for more than 5 (leaving planes out tells more
/// then), and where the error is less than half a voxel, the step in which offsets are searched.
std::optional<HeldOutErrors> displace_planes(const Drawing& drawing, const Image& image, const ImplicitFunction& function,
                                             const Work& work);

/// How much of a displacement an image has to take back to be followed for that: not at all, wholly. Chosen so that images
/// which lie beside the drawing are not (docs/decisions/0013-few-planes.md).
inline constexpr Rise kTakenBack{0.2, 0.3};
/// And with three planes, to be followed for what leaving one of them out says: two are left then, which tell little.
inline constexpr Rise kNotDenied{0.1, 0.2};

}  // namespace kontur
