// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/png.h"

#include <fmt/format.h>
#include <png.h>

#include "kontur/base/error.h"
#include "kontur/io/atomic_file.h"

namespace kontur {
namespace {

void check_picture(const RgbImage& image) {
    const bool has_pixels = image.width > 0 && image.height > 0;
    if (!has_pixels ||
        image.bytes.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("a picture of {} x {} pixels with {} bytes; 3 per pixel are needed", image.width,
                                image.height, image.bytes.size()));
}

std::string encode(const RgbImage& image) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(header), '\0');
    png_alloc_size_t size = bytes.size();
    if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.bytes.data(), 0, nullptr))
        throw Error(ErrorKind::too_large, fmt::format("a picture of {} x {} pixels cannot be encoded: {}", image.width,
                                                      image.height, header.message));
    bytes.resize(size);
    return bytes;
}

}  // namespace

void write_png(const std::filesystem::path& path, const RgbImage& image) {
    check_picture(image);
    write_file_atomically(path, encode(image));
}

}  // namespace kontur
