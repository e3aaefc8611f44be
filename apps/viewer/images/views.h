// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "kontur/shape/volume.h"
#include "kontur/view/orientation.h"
#include "kontur/view/window.h"

namespace kontur::viewer {

/// Where a view starts and how far it scrolls.
struct View {
    Plane plane;       ///< through the centre of the voxel in the image's middle
    double step_mm;    ///< distance of the image's slices along the normal
    double width_mm;   ///< extent of the image along u
    double height_mm;  ///< ... and v
    double from_mm;    ///< first and last slice along the normal, from the plane's origin
    double to_mm;
};

/// The slice of the image's own axes that is nearest to the anatomical one, seen the radiological way round: in an oblique
/// scan the slices as they were acquired.
View view_of(const Grid& grid, SliceKind kind);

/// What the views along the image's axes are called, by SliceKind, and which one of them comes first.
struct ViewNames {
    std::array<std::string, 3> titles{"Axial", "Sagittal", "Coronal"};
    SliceKind first = SliceKind::axial;
};

/// Where an axis of the image runs more than 20 degrees off the patient's, anatomical names would be wrong: then they are
/// "Acquisition", the slices as they were taken and the first ones to look at, "Row", which is spanned by their rows and the
/// way from slice to slice, and "Column". Slices lie across the third axis, unless another one's spacing is the largest by
/// far: files of other formats than DICOM may have their axes in any order.
ViewNames view_names(const Grid& grid);

/// One that is parallel to none of the image's axes: the coronal view turned by 45 degrees about its vertical axis.
View oblique_view(const Grid& grid);

struct WindowPreset {
    std::string name;
    Window window;
};

/// Whether the values look like Hounsfield units: from air to soft tissue.
bool looks_like_ct(const Image& image);
/// For CT the usual ones, for other images one from the values.
std::vector<WindowPreset> window_presets(const Image& image);

/// The outermost points of the voxels, in mm, i fastest.
std::array<Vec3, 8> outer_corners(const Grid& grid);

/// The distance of the slices that a view across `normal` shows: the image's own when it is parallel to them within a
/// degree, else the smallest spacing.
double slice_step_mm(const Grid& grid, const Vec3& normal);

/// Smallest and largest finite value.
std::pair<double, double> value_range(const Image& image);

}  // namespace kontur::viewer
