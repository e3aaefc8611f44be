// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "facts.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/sureness/image_slice.h"

namespace kontur::app {

/// suggest with a --mask: planes in which its border is unlike the image.
void run_for_mask(const SuggestCommand& command, Console& console);

/// suggest of contours of several moments: frames, each with a plane.
void run_for_frames(const SuggestCommand& command, ReadContours read, Console& console);

/// The outlines of a surface in planes: to be corrected, not to be believed. Name and attributes are those of `drawn`.
ContourSet sketch_of(const std::vector<Plane>& planes, const TriangleMesh& mesh, const ContourSet& drawn);

Facts triple(const Vec3& v);

/// Where a suggested plane lies, for people: "2: through ... mm, across ..., slice k = 7".
std::string line_of(std::size_t number, const Plane& plane, const std::optional<ImageSlice>& slice);
/// Slices count from 0, as voxel indices do.
Facts facts_of(const ImageSlice& slice);

}  // namespace kontur::app
