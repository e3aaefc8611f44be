// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kontur/base/geometry.h"

namespace kontur {

/// The side of the patient that a direction (LPS, any length > 0) points to: R or L, A or P, I or S, the strongest first;
/// a weaker one is added where the direction turns towards it by more than 15 degrees ("L", "LA", "SAR").
std::string orientation_letters(const Vec3& direction);

/// What stands at the edges of a screen whose rows run along `plane.u` and whose columns run down along `plane.v`.
struct EdgeLetters {
    std::string left, right, top, bottom;
};
EdgeLetters edge_letters(const Plane& plane);

/// The anatomical slice that a plane's normal is nearest to.
enum class SliceKind { axial, sagittal, coronal };
SliceKind slice_kind(const Vec3& normal);

/// Angle in degrees between a plane's normal and the axis of its `slice_kind`, 0 to 54.7.
double obliquity_deg(const Vec3& normal);

/// Screen planes through `origin` in the radiological convention, normals into the screen: axial seen from the feet and
/// coronal from the front, both with the patient's right on the left; sagittal seen from the left, anterior on the left.
Plane screen_plane(SliceKind kind, const Vec3& origin);

}  // namespace kontur
