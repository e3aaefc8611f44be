// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/png.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>

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

std::string chunk(const std::string& kind, const std::string& content) {
    const std::string body = kind + content;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return big_endian(static_cast<std::uint32_t>(content.size())) + body + big_endian(static_cast<std::uint32_t>(crc));
}

/// An iTXt chunk: keyword, uncompressed, no language, UTF-8 text.
std::string text_chunk(const std::string& keyword, const std::string& text) {
    constexpr std::size_t kMostKeywordBytes = 79;
    return chunk("iTXt", keyword.substr(0, kMostKeywordBytes) + std::string(5, '\0') + text);
}

constexpr std::size_t kHeaderEnd = 8 + 25;  // the signature, IHDR

/// The encoded picture with the chunks behind its header, which libpng's simple interface cannot write.
std::string with_text(std::string png, const Provenance& provenance, std::string chunks = {}) {
    for (const auto& [name, value] : provenance) chunks += text_chunk("kontur " + name, value);
    return png.insert(kHeaderEnd, chunks);
}

/// A part of a picture, in pixels.
struct Region {
    int x = 0, y = 0, width = 1, height = 1;
};

/// Where two pictures differ; one pixel where they do not.
Region difference(const RgbImage& before, const RgbImage& after) {
    int left = after.width, right = -1, top = after.height, bottom = -1;
    for (int y = 0; y < after.height; ++y)
        for (int x = 0; x < after.width; ++x) {
            const auto at = 3 * (static_cast<std::ptrdiff_t>(y) * after.width + x);
            if (std::equal(&after.bytes[at], &after.bytes[at] + 3, &before.bytes[at])) continue;
            left = std::min(left, x);
            right = std::max(right, x);
            top = std::min(top, y);
            bottom = y;
        }
    return right < 0 ? Region{} : Region{left, top, right - left + 1, bottom - top + 1};
}

RgbImage part_of(const RgbImage& image, const Region& region) {
    RgbImage part{.width = region.width, .height = region.height, .bytes = {}};
    for (int y = region.y; y < region.y + region.height; ++y) {
        const auto row = image.bytes.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + region.x);
        part.bytes.insert(part.bytes.end(), row, row + 3 * static_cast<std::ptrdiff_t>(region.width));
    }
    return part;
}

/// Chunks of an animation (W3C PNG, third edition, 11.3.6), with their common sequence numbers.
class AnimationChunks {
public:
    explicit AnimationChunks(double seconds) : milliseconds_(static_cast<std::uint32_t>(std::lround(1000 * seconds))) {}

    std::string control(const Region& region) {
        std::string content = big_endian(number_++);
        for (const int size : {region.width, region.height, region.x, region.y})
            content += big_endian(static_cast<std::uint32_t>(size));
        return chunk("fcTL",
                     content + big_endian(milliseconds_).substr(2) + big_endian(1000).substr(2) + std::string(2, '\0'));
    }

    /// The pixels of a picture by itself, as those of a frame.
    std::string pixels(const std::string& png) {
        std::string chunks;
        for (std::size_t at = 8; at + 8 <= png.size();) {
            std::size_t size = 0;
            for (std::size_t n = 0; n < 4; ++n) size = size << 8 | static_cast<unsigned char>(png[at + n]);
            if (png.compare(at + 4, 4, "IDAT") == 0)
                chunks += chunk("fdAT", big_endian(number_++) + png.substr(at + 8, size));
            at += size + 12;
        }
        return chunks;
    }

private:
    std::uint32_t milliseconds_, number_ = 0;
};

void check_animation(std::span<const RgbImage> pictures, double seconds) {
    if (pictures.empty()) throw Error(ErrorKind::invalid_input, "there is no picture; at least 1 is needed");
    if (!(seconds > 0 && seconds <= 60))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("each picture is seen for {:g} s; above 0 and at most 60 are possible", seconds));
    for (const RgbImage& picture : pictures) {
        check_picture(picture);
        if (picture.width != pictures.front().width || picture.height != pictures.front().height)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("a picture of {} x {} pixels after one of {} x {}; all need one size", picture.width,
                                    picture.height, pictures.front().width, pictures.front().height));
    }
}

}  // namespace

void write_animated_png(const std::filesystem::path& path, std::span<const RgbImage> pictures, double seconds,
                        const Provenance& provenance) {
    check_animation(pictures, seconds);
    AnimationChunks chunks(seconds);
    const RgbImage& first = pictures.front();
    std::string png = encode(first);
    constexpr std::size_t kEndBytes = 12;
    const std::string end = png.substr(png.size() - kEndBytes);
    png.resize(png.size() - kEndBytes);
    const std::string begin = chunk("acTL", big_endian(static_cast<std::uint32_t>(pictures.size())) + big_endian(0)) +
                              chunks.control({0, 0, first.width, first.height});
    for (std::size_t n = 1; n < pictures.size(); ++n) {
        const Region region = difference(pictures[n - 1], pictures[n]);
        png += chunks.control(region);
        png += chunks.pixels(encode(part_of(pictures[n], region)));
    }
    write_file_atomically(path, with_text(png + end, provenance, begin));
}

void write_png(const std::filesystem::path& path, const RgbImage& image, const Provenance& provenance) {
    write_file_atomically(path, encode_png(image, provenance));
}

std::string encode_png(const RgbImage& image, const Provenance& provenance) {
    check_picture(image);
    return with_text(encode(image), provenance);
}

}  // namespace kontur
