// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/view/canvas.h"
#include "kontur/view/moving_picture.h"
#include "kontur/view/picture.h"
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

/// Throws as make_picture does.
void check_picture_size(const PictureOptions& options);

/// The greatest of 1, 2 or 5 times a power of ten that is not above `limit` (> 0).
double round_length(double limit);

/// Title and what is said beside it, and the footer of the whole picture.
void draw_frame_texts(Canvas& canvas, const PanelPlace& picture, const std::string& title, const std::string& subtitle);

/// Captions, and values at the right.
void draw_facts(Canvas& canvas, const PanelPlace& place, Point2 at, const std::vector<PictureFact>& facts);

/// A bar of a round length at the panel's lower left, with that length in mm.
void draw_scale_bar(Canvas& canvas, const PanelPlace& place, double pixel_mm);

/// Letters at the middle of the four edges.
void draw_edge_letters(Canvas& canvas, const PanelPlace& place, const Plane& screen);

/// The shaded surface with the drawn contours on it.
struct SurfaceContent {
    const TriangleMesh& mesh;
    const ContourSet& contours;
    std::span<const Vec3> shown{};  ///< mm, what the view has room for; none: these
};
void draw_surface_panel(Canvas& canvas, const PanelPlace& place, const SurfaceContent& content, const Work& work);

/// A slice of the image (may be null) with the contours and the surface's outline.
struct SliceContent {
    const TriangleMesh& mesh;
    const ContourSet& contours;
    const Image* image;
    Window window;
    double pixel_mm;
};
void draw_slice_panel(Canvas& canvas, const PanelPlace& place, const Slice& slice, const SliceContent& content);

/// The volume over frames, from 0 on, with its interval as a band and dots at frames with contours.
void draw_curve_panel(Canvas& canvas, const PanelPlace& place, const PictureCurve& curve);

}  // namespace kontur::picture
