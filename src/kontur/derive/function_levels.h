// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// The surface of a function, whose mask is given, on the lattice: at the function's zeros, also between the slices and as
/// far as it goes beyond the image. At the voxels of the image the mask decides what is inside.
Levels function_levels(const ImplicitFunction& function, const Mask& mask, const WorkLattice& lattice, const Work& work);

}  // namespace kontur
