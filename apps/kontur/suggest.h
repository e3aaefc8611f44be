// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "commands.h"
#include "facts.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"

namespace kontur::app {

/// suggest with a --mask: planes in which its border is unlike the image.
void run_for_mask(const SuggestCommand& command, Console& console);

/// The outlines of a surface in planes: to be corrected, not to be believed. Name and attributes are those of `drawn`.
ContourSet sketch_of(const std::vector<Plane>& planes, const TriangleMesh& mesh, const ContourSet& drawn);

Facts triple(const Vec3& v);

}  // namespace kontur::app
