// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "kontur/io/bytes/deflate.h"
#include "kontur/io/images/label_name.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A borrowed image or mask, for writers. The source must outlive it.
struct ImageView {
    using Samples = std::variant<std::span<const std::uint8_t>, std::span<const std::int16_t>,
                                 std::span<const std::uint16_t>, std::span<const std::int32_t>, std::span<const float>>;
    const Grid& grid;
    Samples samples;
    Provenance provenance{};          ///< for the format's text fields
    std::vector<LabelName> labels{};  ///< for a format with room for a table of them

    ImageView(const Grid& its_grid, Samples its_samples) : grid(its_grid), samples(its_samples) {}
    ImageView(const Mask& mask) : grid(mask.grid), samples(std::span(mask.values)) {}
    ImageView(const Image& image)
        : grid(image.grid),
          samples(std::visit([](const auto& values) { return Samples(std::span(values)); }, image.samples)) {}
};

/// The samples as files store them.
inline std::span<const std::byte> bytes_of(const ImageView& image) {
    static_assert(std::endian::native == std::endian::little, "writers store samples as they lie in memory, little-endian");
    return std::visit([](const auto& values) { return std::as_bytes(values); }, image.samples);
}

/// `runs` for masks and label maps of one byte to a voxel: where neighbours along i mostly have the same value.
DeflateMode deflate_mode(const ImageView& image);

}  // namespace kontur
