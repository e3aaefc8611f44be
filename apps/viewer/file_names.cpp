// SPDX-License-Identifier: Apache-2.0
#include "viewer/file_names.h"

namespace kontur::viewer {

std::string plain_name(const std::string& name) {
    std::string plain;
    for (const char c : name) {
        const bool is_plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
        plain += is_plain ? c : '_';
    }
    return plain.empty() ? "structure" : plain;
}

std::array<double, 3> rgb(const std::string& color) {
    std::array<double, 3> parts{};
    for (std::size_t i = 0; i < 3; ++i) parts[i] = std::stoi(color.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
    return parts;
}

}  // namespace kontur::viewer
