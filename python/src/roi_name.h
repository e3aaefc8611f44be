// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

namespace kontur::python {

/// What a ROI is chosen by: its name or its number.
using RoiName = std::variant<std::string, std::int64_t>;

inline std::optional<std::string> roi_name(const std::optional<RoiName>& name_or_number) {
    if (!name_or_number) return std::nullopt;
    if (const auto* number = std::get_if<std::int64_t>(&*name_or_number)) return std::to_string(*number);
    return std::get<std::string>(*name_or_number);
}

}  // namespace kontur::python
