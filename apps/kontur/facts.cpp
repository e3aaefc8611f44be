// SPDX-License-Identifier: Apache-2.0
#include "facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/base/printable.h"

namespace kontur::app {
namespace {

constexpr std::size_t kNameWidth = 22;

bool is_empty(const Facts& value) { return value.empty() || (value.is_string() && value.get<std::string>().empty()); }

std::string value_text(const Facts& value) {
    if (value.is_string()) return printable_utf8(value.get<std::string>());
    if (value.is_null()) return "-";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    // 6 digits serve the eye; the JSON has them all.
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_structured()) return value.dump();
    std::string text;
    for (const auto& [name, item] : value.items()) {
        if (is_empty(item)) continue;
        if (!text.empty()) text += value.is_object() ? ", " : " ";
        if (value.is_object()) text += name + " ";
        text += value_text(item);
    }
    return text;
}

bool is_list_of_lines(const Facts& value) {
    return value.is_array() &&
           std::any_of(value.begin(), value.end(), [](const Facts& item) { return item.is_object() || item.is_string(); });
}

}  // namespace

std::string to_text(const Facts& facts) {
    std::string text;
    for (const auto& [name, value] : facts.items()) {
        if (is_empty(value)) {
            text += fmt::format("  {:<{}} none\n", name, kNameWidth);
            continue;
        }
        if (!is_list_of_lines(value)) {
            text += fmt::format("  {:<{}} {}\n", name, kNameWidth, value_text(value));
            continue;
        }
        text += fmt::format("  {}\n", name);
        for (const Facts& item : value) text += fmt::format("    {}\n", value_text(item));
    }
    return text;
}

std::string to_json_text(const Facts& facts) { return facts.dump(2, ' ', false, Facts::error_handler_t::replace) + "\n"; }

Facts number(double value) {
    return std::isfinite(value) ? Facts(value + 0.0) : Facts(fmt::format("{}", value));  // -0.0 + 0.0 is 0.0
}

Facts provenance_facts(const Provenance& provenance) {
    Facts facts = Facts::object();
    for (const auto& [name, value] : provenance) facts[name] = value;
    return facts;
}

}  // namespace kontur::app
