// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/rgb_image.h"
#include "kontur/shape/volume.h"
#include "kontur/view/window.h"

namespace kontur {

/// A line of the picture's table: a caption and a value with its unit.
struct PictureFact {
    std::string caption, value;
};

/// A volume with four significant digits and its unit, however small it is.
std::string in_ml(double volume_ml);

struct PictureOptions {
    int width_px = 1600;                  ///< at least 320
    int height_px = 1000;                 ///< at least 200
    std::string title = {};               ///< empty: the contour set's name
    std::vector<PictureFact> facts = {};  ///< below the volume and the counts, which the picture gives by itself
    std::optional<Window> window = {};    ///< of the slices; unset: `suggest_window` of the object's surroundings
    bool has_surface = true;              ///< false: the picture is of the contours alone, and the mesh is empty
};

/// One picture of a segmentation that is understood at once: the surface in 3D seen from the patient's front, left and
/// above, with the drawn contours on it (hidden parts faint); an axial, a sagittal and a coronal slice of the image with the
/// contours drawn in that slice, dots where other contours cross it, and the surface's outline; scales, orientation letters,
/// legend and figures. Slices lie where most was drawn, else through the object's middle; they are turned to a
/// tilted stack of contours (see `choose_slices`). Without an image (null) the slices
/// stand on a plain ground; an empty mesh gives a picture that says so. Same input, same bytes (with the same fonts).
/// Well under a second for 400,000 triangles on two cores. Throws Error(invalid_input) for a picture below the least size,
/// a window that is not finite or of no width, and what `check_mesh` and `check_image` refuse, Error(too_large) above 16384
/// pixels on a side.
RgbImage make_picture(const TriangleMesh& mesh, const ContourSet& contours, const Image* image,
                      const PictureOptions& options = {}, const Work& work = {});

}  // namespace kontur
