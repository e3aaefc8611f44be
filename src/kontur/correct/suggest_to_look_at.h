// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/volume.h"
#include "kontur/sureness/image_slice.h"

namespace kontur {

struct LookAtOptions {
    PlaneChoice planes = PlaneChoice::any;  ///< image_slices: layers of the mask's voxels
    std::vector<Plane> seen{};              ///< looked at already: what lies within a correction's reach of them counts less
};

/// A plane in which a mask's border is unlike the image.
struct PlaneToLookAt {
    Plane plane;                        ///< its origin lies amid what is doubtful there
    std::optional<ImageSlice> slice{};  ///< of the mask's voxels, if the plane is one
    double doubtful_mm2 = 0;            ///< expected area on the wrong side, by the image alone
};

/// Which planes of a mask to look at next, best first, each as if those before it had been looked at. Along the mask's
/// border, what the image shows is compared with how the mask's inside and outside look nearby (LocalLooks); a voxel that
/// looks like the other side is doubtful, and the plane with most of them is the first. A hint: where a whole part is wrong
/// its border looks like any other, so a leak or a missing pole is missed. Fewer than `count` planes where nothing is
/// doubtful any more. The same bytes for any number of threads. Throws Error(invalid_input) for a count of 0 and an image
/// that shows nothing at the border.
std::vector<PlaneToLookAt> suggest_to_look_at(const ExistingSurface& surface, const Image& image, std::size_t count = 1,
                                              const LookAtOptions& options = {}, const Work& work = {});

}  // namespace kontur
