// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kontur/base/work.h"
#include "kontur/view/canvas.h"
#include "kontur/view/slices.h"
#include "kontur/view/window.h"

// The parts of `make_picture`; not for other callers.
namespace kontur::picture {

// Amber and blue stay apart for colour-blind eyes and on grey.
inline constexpr Color kGround{0.055, 0.067, 0.086};
inline constexpr Color kPanel{0.098, 0.118, 0.149};
inline constexpr Color kFrame{0.23, 0.27, 0.33};
inline constexpr Color kText{0.93, 0.95, 0.97};
inline constexpr Color kMuted{0.60, 0.66, 0.73};
inline constexpr Color kDrawn{1.0, 0.71, 0.16};
inline constexpr Color kSurface{0.30, 0.79, 0.94};
inline constexpr Color kMaterial{0.38, 0.64, 0.78};

/// Where a panel stands, and the length in pixels of what measures 1 on a picture of 1600 x 1000.
struct PanelPlace {
    Rect rect;
    double unit = 1;
};

/// A number with the given significant digits, at least all digits before the decimal point.
std::string rounded(double value, int digits);

/// `suggest_window` of what lies in the box (mm) and as far around it as half of its size, except for CT: a lesion in a
/// PET, or an object in an image that is mostly empty, is beyond the 99th percentile of the whole.
Window window_about(const Image& image, const Box3& box_mm);

/// A bar of a round length at the panel's lower left, with that length in mm.
void draw_scale_bar(Canvas& canvas, const PanelPlace& place, double pixel_mm);

/// Letters at the middle of the four edges.
void draw_edge_letters(Canvas& canvas, const PanelPlace& place, const Plane& screen);

/// The shaded surface with the drawn contours on it.
void draw_surface_panel(Canvas& canvas, const PanelPlace& place, const TriangleMesh& mesh, const ContourSet& contours,
                        const Work& work);

/// A slice of the image (may be null) with the contours and the surface's outline.
struct SliceContent {
    const TriangleMesh& mesh;
    const ContourSet& contours;
    const Image* image;
    Window window;
    double pixel_mm;
};
void draw_slice_panel(Canvas& canvas, const PanelPlace& place, const Slice& slice, const SliceContent& content);

}  // namespace kontur::picture
