// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"
#include "kontur/view/orientation.h"

namespace kontur {

/// One slice through the object, as a screen shows it.
struct Slice {
    SliceKind kind = SliceKind::axial;
    Plane plane;          ///< radiological screen plane (see `screen_plane`), origin at the middle of the object's extent
    double width_mm = 0;  ///< the object's extent along u and v
    double height_mm = 0;
    double thickness_mm = 1;  ///< of the image's slices along the normal; 1 without an image

    /// Whether the contour was drawn in this slice: all of its points within half a slice.
    bool contains(const Contour& contour) const;
};

/// The axial, coronal and sagittal slice that show most of what was drawn: each at the position with the greatest length of
/// contours in it, or through the middle of the object. When the contours form a stack that is parallel to none of the
/// patient's planes (more than half of their length, within 5 degrees), the three are turned together so that one of them
/// is parallel to the stack.
/// `image` may be null.
std::array<Slice, 3> choose_slices(const TriangleMesh& mesh, const ContourSet& contours, const Image* image);

}  // namespace kontur
