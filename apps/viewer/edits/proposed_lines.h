// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/view/outline.h"

namespace kontur::viewer {

/// The lines in which a surface cuts a plane, to be proposed as contours there, without specks: lines that enclose less than
/// a hundredth of what the largest does, as where a thin part leaves the plane.
std::vector<Polyline> proposed_lines(const TriangleMesh& mesh, const Plane& plane);

}  // namespace kontur::viewer
