// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/phantom/bodies.h"
#include "kontur/phantom/random.h"

/// The planes in which the phantom's contours lie. Internal to the phantom.
namespace kontur {

/// Box of the body's inside, to about a hundredth of its size.
Box3 extent(const Body& body);

/// Axial planes at equal distances. The first and the last are nearly a whole distance away from the box's ends.
std::vector<Plane> parallel_planes(const Box3& box, int count);

/// Planes across all three axes. Along each axis 14 % of the box lie beyond the first plane, and 14 % beyond the last.
std::vector<Plane> orthogonal_planes(const Box3& box, int sagittal, int coronal, int axial);

/// Planes in random directions through random points of the middle half of the box.
std::vector<Plane> oblique_planes(const Box3& box, int count, Random& random);

/// Planes through the box's vertical middle axis at equal angles.
std::vector<Plane> radial_planes(const Box3& box, int count);

}  // namespace kontur
