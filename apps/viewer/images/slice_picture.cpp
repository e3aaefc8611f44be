// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/slice_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kontur/view/reslice.h"
#include "kontur/view/window.h"
#include "viewer/model/binary_reply.h"

namespace kontur::viewer {
namespace {

Reslice small_raster(const Grid& grid, int longer_side) {
    const Vec3 row = grid.index_to_mm.column(0), column = grid.index_to_mm.column(1);
    const double width_mm = norm(row) * static_cast<double>(grid.size.i);
    const double height_mm = norm(column) * static_cast<double>(grid.size.j);
    const double pixel_mm = std::max(width_mm, height_mm) / longer_side;
    const auto pixels = [&](double mm) { return std::max(1, static_cast<int>(mm / pixel_mm)); };
    const Plane plane{grid.bounds_mm().center(), normalized(cross(row, column)), normalized(row), normalized(column)};
    return centered_reslice(plane, pixels(width_mm), pixels(height_mm), pixel_mm);
}

}  // namespace

std::string slice_picture(const Image& image, int pixels, nlohmann::json header) {
    const Reslice raster = small_raster(image.grid, pixels);
    const Window window = suggest_window(image);
    const std::vector<float> values = reslice(image, raster, static_cast<float>(window.center - window.width));
    std::vector<std::uint8_t> shades(values.size());
    std::ranges::transform(values, shades.begin(), [&](float value) {
        return static_cast<std::uint8_t>(std::lround(255 * brightness(value, window)));
    });
    header["width"] = raster.width;
    header["height"] = raster.height;
    BinaryReply reply(std::move(header));
    reply.add<std::uint8_t>("pixels", shades);
    return reply.bytes();
}

}  // namespace kontur::viewer
