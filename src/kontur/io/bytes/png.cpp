// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/png.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"

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

std::string big_endian(std::uint32_t number) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xFF);
    return bytes;
}

/// An iTXt chunk: keyword, uncompressed, no language, UTF-8 text.
std::string text_chunk(const std::string& keyword, const std::string& text) {
    constexpr std::size_t kMostKeywordBytes = 79;
    const std::string body = "iTXt" + keyword.substr(0, kMostKeywordBytes) + std::string(5, '\0') + text;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(static_cast<std::uint32_t>(crc));
}

/// The encoded picture with the chunks behind its header, which libpng's simple interface cannot write.
std::string with_text(std::string png, const Provenance& provenance) {
    constexpr std::size_t kHeaderEnd = 8 + 25;  // the signature, IHDR
    std::string chunks;
    for (const auto& [name, value] : provenance) chunks += text_chunk("kontur " + name, value);
    return png.insert(kHeaderEnd, chunks);
}

}  // namespace

void write_png(const std::filesystem::path& path, const RgbImage& image, const Provenance& provenance) {
    write_file_atomically(path, encode_png(image, provenance));
}

std::string encode_png(const RgbImage& image, const Provenance& provenance) {
    check_picture(image);
    return with_text(encode(image), provenance);
}

}  // namespace kontur
