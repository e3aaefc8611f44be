// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/reslice.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"

namespace kontur {
namespace {

/// The two neighbours of a fractional index along one axis, as array offsets, and the weight of the upper one.
struct Neighbours {
    std::int64_t lower, upper;
    double weight;
};

bool covers(std::int64_t size, double index) { return index >= -0.5 && index <= static_cast<double>(size) - 0.5; }

Neighbours neighbours(std::int64_t size, std::int64_t stride, double index) {
    const double inside = std::clamp(index, 0.0, static_cast<double>(size - 1));
    const auto lower = static_cast<std::int64_t>(inside);
    const std::int64_t upper = std::min(lower + 1, size - 1);
    return {lower * stride, upper * stride, inside - static_cast<double>(lower)};
}

template <class Sample>
double trilinear(const Sample* s, const Neighbours& i, const Neighbours& j, const Neighbours& k) {
    const auto along_i = [&](std::int64_t row) {
        const auto a = static_cast<double>(s[row + i.lower]), b = static_cast<double>(s[row + i.upper]);
        return a + i.weight * (b - a);
    };
    const auto along_j = [&](std::int64_t slice) {
        const double a = along_i(slice + j.lower);
        return a + j.weight * (along_i(slice + j.upper) - a);
    };
    const double a = along_j(k.lower);
    return a + k.weight * (along_j(k.upper) - a);
}

/// Places in an image, at equal steps of its index.
struct IndexLine {
    Vec3 start, step;
};

template <class Sample>
void sample_row(const std::vector<Sample>& samples, const Index3& size, const IndexLine& line, float outside,
                std::span<float> row) {
    Vec3 index = line.start;
    for (float& pixel : row) {
        const bool inside = covers(size.i, index.x) && covers(size.j, index.y) && covers(size.k, index.z);
        pixel = !inside ? outside
                        : static_cast<float>(trilinear(samples.data(), neighbours(size.i, 1, index.x),
                                                       neighbours(size.j, size.i, index.y),
                                                       neighbours(size.k, size.i * size.j, index.z)));
        index += line.step;
    }
}

double rows_mm(const Reslice& raster) { return raster.row_mm == 0 ? raster.pixel_mm : raster.row_mm; }

void check_raster(const Reslice& raster) {
    if (raster.width < 1 || raster.height < 1)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("a slice of {} x {} pixels; at least 1 x 1 is needed", raster.width, raster.height));
    constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
    if (std::int64_t{raster.width} * raster.height > kMostPixels)
        throw Error(ErrorKind::too_large, fmt::format("a slice of {} x {} pixels; at most {} in all are possible",
                                                      raster.width, raster.height, kMostPixels));
    for (const double mm : {raster.pixel_mm, rows_mm(raster)})
        if (!(mm > 0 && std::isfinite(mm)))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("a slice with a pixel size of {:g} mm; more than 0 is needed", mm));
}

}  // namespace

Reslice centered_reslice(const Plane& plane, int width, int height, double pixel_mm) {
    Reslice raster{plane, width, height, pixel_mm};
    raster.plane.origin = plane.from_uv(-0.5 * (width - 1) * pixel_mm, -0.5 * (height - 1) * pixel_mm);
    return raster;
}

std::vector<float> reslice(const Image& image, const Reslice& raster, float outside) {
    check_raster(raster);
    check_image(image);
    const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
    const Vec3 step = mm_to_index.apply_linear(raster.pixel_mm * raster.plane.u);
    const auto width = static_cast<std::size_t>(raster.width);

    std::vector<float> pixels(width * static_cast<std::size_t>(raster.height));
    parallel_for(raster.height, 32, 0, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const Vec3 start = mm_to_index.apply(raster.plane.from_uv(0, static_cast<double>(row) * rows_mm(raster)));
            const std::span target(pixels.data() + static_cast<std::size_t>(row) * width, width);
            std::visit(
                [&](const auto& s) {
                    sample_row(s, image.grid.size, {start, step}, outside, target);
                },
                image.samples);
        }
    });
    return pixels;
}

}  // namespace kontur
