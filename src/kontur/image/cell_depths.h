// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/adaptive.h"
#include "kontur/function/implicit_function.h"
#include "kontur/image/image_cells.h"
#include "kontur/image/movement.h"

namespace kontur {

/// Edges: what lies between cells is in all of them, however it is rounded.
inline constexpr double kBetweenCells = 1e-6;

/// How the cells of an image lie to a surface and to the contours that it runs through, to half a cell.
struct CellDepths {
    std::vector<float> depth_mm;         ///< of each cell below the surface; above it less than 0
    std::vector<float> far_mm;           ///< of each cell from the contours
    std::vector<std::uint32_t> nearest;  ///< to each cell, of those just below the surface

    bool is_inside(std::size_t cell) const { return depth_mm[cell] > 0; }
};

/// Whether a way among cells is longer than so many edges. It is often just as long, and is not longer then, however the two
/// are rounded.
inline bool is_longer(float mm, double edges, const ImageCells& cells) {
    constexpr double kRounding = 1e-5;
    return static_cast<double>(mm) > (edges + kRounding) * cells.edge_mm();
}

/// How deep cells lie below the surface of those inside; `nearest` as in CellDepths.
struct Depths {
    std::vector<float> depth_mm;
    std::vector<std::uint32_t> nearest;
};
Depths depths_of(const std::vector<std::uint8_t>& inside, const ImageCells& cells);

/// Of the surface of f that hangs together with the contours.
CellDepths cell_depths(const ImageCells& cells, const ImplicitFunction& function, const ContourSet& contours,
                       const Work& work = {}, Doubts doubts = Doubts::resolved);

/// Depths between those below two surfaces, of which the second counts so much.
CellDepths between(const CellDepths& first, const CellDepths& second, double share);

/// Cells near a plane.
struct CellSlab {
    Plane plane{};
    double half_mm = std::numeric_limits<double>::infinity();  ///< unless told otherwise all cells are near

    bool holds(const Vec3& center) const { return std::abs(plane.distance_to(center)) <= half_mm; }
};

/// The surface of f, and how far the image moves it.
struct MovedSurface {
    const ImplicitFunction& function;
    const Movement& movement;
    const Beliefs& beliefs;
};

/// The same of the surface moved along its normals, by what moves the nearest place of it; beyond the slab it stays.
CellDepths moved_depths(const CellDepths& depths, const ImageCells& cells, const MovedSurface& surface, const CellSlab& near,
                        const Work& work = {});

}  // namespace kontur
