// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/mesh.h"
#include "kontur/view/camera.h"

namespace kontur {

/// What lies nearest to the viewer at the centre of each pixel.
struct DepthBuffer {
    struct Pixel {
        float depth_mm = -std::numeric_limits<float>::infinity();  ///< towards the viewer
        std::array<float, 3> normal{};                             ///< unit, on the screen: right, up, towards the viewer
        bool is_covered() const { return depth_mm > -std::numeric_limits<float>::infinity(); }
    };
    int width = 0;
    int height = 0;
    std::vector<Pixel> pixels;

    const Pixel& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

/// Fills the triangles by a depth test with interpolated normals, which are turned to face the viewer. A triangle
/// with a point that is not finite is left out.
DepthBuffer render_depth(const TriangleMesh& mesh, const Camera& camera, const Work& work);

}  // namespace kontur
