// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/image_view.h"

namespace kontur {

DeflateMode deflate_mode(const ImageView& image) {
    constexpr std::size_t kEvery = 61;  // pairs of neighbours that are looked at; a prime, so that no row is missed
    constexpr double kLeastEqualShare =
        0.98;  // coarser label maps become larger by an eighth; images of 8 bits have .8 at most
    const auto* values = std::get_if<std::span<const std::uint8_t>>(&image.samples);
    if (!values) return DeflateMode::dense;
    std::size_t pairs = 0, equal = 0;
    for (std::size_t n = 1; n < values->size(); n += kEvery, ++pairs) equal += (*values)[n] == (*values)[n - 1] ? 1 : 0;
    return static_cast<double>(equal) >= kLeastEqualShare * static_cast<double>(pairs) ? DeflateMode::runs
                                                                                       : DeflateMode::dense;
}

}  // namespace kontur
