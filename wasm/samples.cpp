// SPDX-License-Identifier: Apache-2.0
#include "samples.h"

#include <array>
#include <cstddef>
#include <variant>

#include "kontur/base/error.h"

namespace kontur::wasm {
namespace {

/// In the order of Image::Samples.
constexpr std::array<std::string_view, 5> kTypes{"Uint8Array", "Int16Array", "Uint16Array", "Int32Array", "Float32Array"};

template <class Sample>
Image::Samples samples_at(const void* samples, const Grid& grid) {
    const auto* first = static_cast<const Sample*>(samples);
    return std::vector<Sample>(first, first + grid.voxel_count());
}

}  // namespace

Image image_from(const void* samples, std::string_view type, const Grid& grid) {
    if (type == kTypes[0]) return {grid, samples_at<std::uint8_t>(samples, grid)};
    if (type == kTypes[1]) return {grid, samples_at<std::int16_t>(samples, grid)};
    if (type == kTypes[2]) return {grid, samples_at<std::uint16_t>(samples, grid)};
    if (type == kTypes[3]) return {grid, samples_at<std::int32_t>(samples, grid)};
    if (type == kTypes[4]) return {grid, samples_at<float>(samples, grid)};
    throw Error(ErrorKind::unsupported, "an image is a Uint8Array, Int16Array, Uint16Array, Int32Array or Float32Array");
}

std::vector<std::uint8_t> bytes_of(const Image& image) {
    return std::visit(
        [](const auto& samples) {
            const auto* first = reinterpret_cast<const std::uint8_t*>(samples.data());
            return std::vector<std::uint8_t>(first, first + samples.size() * sizeof(samples[0]));
        },
        image.samples);
}

std::string_view type_of(const Image& image) { return kTypes[image.samples.index()]; }

}  // namespace kontur::wasm
