// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: what is drawn in a plane, on a lattice of pixels.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kontur/shape/section.h"

namespace kontur {

/// Pixels of a plane, rows of them one after another.
struct PixelLattice {
    Point2 low{};  ///< middle of the first one, mm
    double step_mm = 1;
    int columns = 0, rows = 0;

    std::size_t count() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    }
    Point2 at(std::size_t index) const {
        const auto width = static_cast<std::size_t>(columns);
        return {low[0] + step_mm * static_cast<double>(index % width),
                low[1] + step_mm * static_cast<double>(index / width)};
    }
    double pixel_mm2() const { return step_mm * step_mm; }
    /// The pixel around a place, if there is one.
    std::optional<std::size_t> pixel_at(const Point2& p) const {
        const double column = std::floor((p[0] - low[0]) / step_mm + 0.5), row = std::floor((p[1] - low[1]) / step_mm + 0.5);
        if (!(column >= 0 && row >= 0 && column < columns && row < rows)) return std::nullopt;
        return index(static_cast<int>(column), static_cast<int>(row));
    }
};

/// What a section encloses, on pixels with a margin around it.
struct SectionRaster {
    PixelLattice lattice;
    std::vector<std::uint8_t> filled;
    double area_mm2 = 0;   ///< of the filled pixels
    double extent_mm = 0;  ///< the larger side of the outlines' box
    Box2 box{};            ///< of the outlines

    /// Whether a place is drawn as object; beyond the pixels nothing is.
    bool contains(const Point2& p) const {
        const auto pixel = lattice.pixel_at(p);
        return pixel && filled[*pixel] != 0;
    }
};

/// 80 to 160 pixels go across the outlines, as many as the mean width of what they enclose needs.
SectionRaster rasterize(const Section& section);

/// 4-connected parts of the marked pixels: for each pixel the number of its part, from 1; 0 where none is marked.
struct PixelParts {
    std::vector<std::uint32_t> part;
    std::uint32_t count = 0;
};
PixelParts connected_parts(const PixelLattice& lattice, const std::vector<std::uint8_t>& marked);

}  // namespace kontur
