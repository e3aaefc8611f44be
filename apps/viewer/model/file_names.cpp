// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/file_names.h"

#include <fmt/format.h>

#include "kontur/shape/structure_attributes.h"

namespace kontur::viewer {

std::string plain_name(const std::string& name) {
    std::string plain;
    for (const char c : name) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
        if (is_plain) plain += c;
        else if (!plain.ends_with('_')) plain += '_';
    }
    return plain.empty() ? "structure" : plain;
}

std::array<double, 3> rgb(const std::string& color) { return to_levels(rgb8(color)); }

std::array<std::uint8_t, 3> rgb8(const std::string& color) {
    std::array<std::uint8_t, 3> levels{};
    for (std::size_t i = 0; i < 3; ++i)
        levels[i] = static_cast<std::uint8_t>(std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16));
    return levels;
}

std::string color_text(const std::array<std::uint8_t, 3>& levels) {
    return fmt::format("#{:02x}{:02x}{:02x}", levels[0], levels[1], levels[2]);
}

}  // namespace kontur::viewer
