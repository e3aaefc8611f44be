// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/mesh.h"
#include "kontur/view/camera.h"

namespace kontur {

/// A surface as a camera sees it.
struct ShadedSurface {
    int width = 0;
    int height = 0;
    std::vector<std::uint32_t> argb;  ///< 0xAARRGGBB, colour multiplied by alpha (cairo's ARGB32); 0 beside the surface
    std::vector<float> depth_mm;  ///< towards the viewer (see Camera::project), nearest within the pixel; -infinity beside
};

struct ShadeOptions {
    Vec3 color{0.42, 0.66, 0.78};  ///< of the material, sRGB 0 to 1
    int samples = 2;               ///< per pixel and axis, against stair steps
};

/// The mesh under a key light from the upper left, a fill light from the right and light from all around, darker where the
/// surface's own relief keeps that light out (ambient occlusion from the depth buffer). Normals are taken from the mesh or,
/// if it has none, averaged over the triangles by area; both sides of a triangle are visible. The same bytes for any number
/// of threads. Linear in triangles and pixels: 400,000 triangles on
/// 800 x 900 pixels take well under a second.
ShadedSurface shade(const TriangleMesh& mesh, const Camera& camera, const ShadeOptions& options = {}, const Work& work = {});

}  // namespace kontur
