// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/section_raster.h"

#include <algorithm>

namespace kontur {
namespace {

// Pixels lie a little beside the outlines' corners, which often are on round numbers.
constexpr double kAside = 0.377;
constexpr double kMargin = 0.15;  // around the outlines, of their extent

PixelLattice lattice_around(const Box2& box, double step, double margin) {
    PixelLattice lattice{{box.low[0] - margin + kAside * step, box.low[1] - margin + kAside * step}, step, 0, 0};
    lattice.columns = static_cast<int>((box.high[0] + margin - lattice.low[0]) / step) + 1;
    lattice.rows = static_cast<int>((box.high[1] + margin - lattice.low[1]) / step) + 1;
    return lattice;
}

/// Adds the outline's layer to the pixels inside of it, row by row.
void add_layer(const Polygon2& outline, int layer, const PixelLattice& lattice, std::vector<std::int16_t>& layers) {
    const std::vector<std::vector<double>> crossings = row_crossings(outline, lattice.low[1], lattice.step_mm, lattice.rows);
    for (int row = 0; row < lattice.rows; ++row) {
        const std::vector<double>& here = crossings[static_cast<std::size_t>(row)];
        for (std::size_t n = 0; n + 1 < here.size(); n += 2) {
            const auto column = [&](double x) {
                return std::clamp(static_cast<int>(std::ceil((x - lattice.low[0]) / lattice.step_mm)), 0, lattice.columns);
            };
            for (int c = column(here[n]); c < column(here[n + 1]); ++c)
                layers[lattice.index(c, row)] = static_cast<std::int16_t>(layers[lattice.index(c, row)] + layer);
        }
    }
}

void fill(const Section& section, SectionRaster& raster) {
    std::vector<std::int16_t> layers(raster.lattice.count());
    for (std::size_t o = 0; o < section.outlines.size(); ++o)
        add_layer(section.outlines[o], section.layer(o), raster.lattice, layers);
    raster.filled.assign(layers.size(), 0);
    std::size_t pixels = 0;
    for (std::size_t n = 0; n < layers.size(); ++n) pixels += raster.filled[n] = layers[n] > 0;
    raster.area_mm2 = static_cast<double>(pixels) * raster.lattice.pixel_mm2();
}

}  // namespace

SectionRaster rasterize(const Section& section) {
    constexpr double kFewest = 80, kMost = 160;  // pixels across the outlines
    constexpr double kOfWidth = 0.4;             // a pixel's, of the mean width of what is enclosed
    SectionRaster raster;
    double length = 0;
    for (const Polygon2& outline : section.outlines) {
        for (const Point2& vertex : outline) raster.box.extend(vertex);
        length += perimeter(outline);
    }
    raster.extent_mm = std::max(raster.box.high[0] - raster.box.low[0], raster.box.high[1] - raster.box.low[1]);
    if (!(raster.extent_mm > 0)) return raster;
    double step = raster.extent_mm / kFewest;
    raster.lattice = lattice_around(raster.box, step, std::max(kMargin * raster.extent_mm, 4 * step));
    fill(section, raster);
    const double spacing = kOfWidth * 2 * raster.area_mm2 / length;
    if (raster.area_mm2 > 0 && spacing >= step) return raster;
    step = std::max(spacing, raster.extent_mm / kMost);
    raster.lattice = lattice_around(raster.box, step, std::max(kMargin * raster.extent_mm, 4 * step));
    fill(section, raster);
    return raster;
}

PixelParts connected_parts(const PixelLattice& lattice, const std::vector<std::uint8_t>& marked) {
    PixelParts parts{std::vector<std::uint32_t>(marked.size(), 0), 0};
    const auto width = static_cast<std::size_t>(lattice.columns);
    std::vector<std::size_t> front;
    for (std::size_t start = 0; start < marked.size(); ++start) {
        if (!marked[start] || parts.part[start] != 0) continue;
        parts.part[start] = ++parts.count;
        front.push_back(start);
        while (!front.empty()) {
            const std::size_t n = front.back(), column = n % width;
            front.pop_back();
            const auto visit = [&](std::size_t next) {
                if (!marked[next] || parts.part[next] != 0) return;
                parts.part[next] = parts.count;
                front.push_back(next);
            };
            if (column > 0) visit(n - 1);
            if (column + 1 < width) visit(n + 1);
            if (n >= width) visit(n - width);
            if (n + width < marked.size()) visit(n + width);
        }
    }
    return parts;
}

}  // namespace kontur
