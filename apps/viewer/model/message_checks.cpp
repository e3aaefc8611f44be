// SPDX-License-Identifier: Apache-2.0
#include "viewer/model/message_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

std::size_t characters(const std::string& utf8) {
    return static_cast<std::size_t>(std::ranges::count_if(utf8, [](char c) { return (c & 0xc0) != 0x80; }));
}

/// Short enough for a sentence.
std::string short_text(const json& value) {
    constexpr std::size_t kMost = 40;
    if (value.is_array()) return fmt::format("a list of {}", value.size());
    if (value.is_object()) return "an object";
    if (value.is_string() && characters(value.get_ref<const std::string&>()) > kMost)
        return fmt::format("a text of {} characters", characters(value.get_ref<const std::string&>()));
    return value.dump();
}

/// Where in a message a value stands; the way up to it is spelt out only for a sentence.
struct JsonPlace {
    const JsonPlace* above = nullptr;
    std::string_view name = {};
    std::size_t index = 0;

    std::string text() const {
        if (!above) return "";
        if (name.empty()) return fmt::format("{}[{}]", above->text(), index);
        return above->above ? fmt::format("{}.{}", above->text(), name) : std::string(name);
    }
};

bool is_between(double value, const Type& type) {
    return value >= type.least && value <= type.most && !(type.is_above_least && value == type.least);
}

bool is_text(const std::string& text, const Type& type) {
    if (!type.words.empty()) return std::ranges::find(type.words, text) != type.words.end();
    if (type.pattern && (text.size() > 100 || !std::regex_match(text, std::regex(type.pattern)))) return false;
    return is_between(static_cast<double>(characters(text)), type);
}

/// By itself, whatever is in it.
bool fits(const json& value, const Type& type) {
    switch (type.kind) {
        case Type::any:
            return true;
        case Type::null:
            return value.is_null();
        case Type::boolean:
            return value.is_boolean();
        case Type::number:
            return value.is_number() && std::isfinite(value.get<double>()) && is_between(value.get<double>(), type);
        case Type::integer:
            // An unsigned number beyond int64 would wrap; comparing it as a double keeps it out.
            return value.is_number_integer() && is_between(value.get<double>(), type);
        case Type::text:
            return value.is_string() && is_text(value.get_ref<const std::string&>(), type);
        case Type::list:
            return value.is_array() && is_between(static_cast<double>(value.size()), type);
        case Type::object:
            return value.is_object();
        case Type::either:
            return std::ranges::any_of(type.choices, [&](const Type* one) { return fits(value, *one); });
    }
    return false;
}

void check(const json& value, const Type& type, const JsonPlace& place) {
    if (!fits(value, type)) refuse(fmt::format("'{}' is {}; {} is needed", place.text(), short_text(value), type.needed));
    for (const auto& [name, member, is_needed] : type.members) {
        const JsonPlace inside{&place, name};
        if (const auto found = value.find(name); found != value.end()) check(*found, *member, inside);
        else if (is_needed) refuse(fmt::format("'{}' is missing; {} is needed", inside.text(), member->needed));
    }
    if (type.items)
        for (std::size_t i = 0; i < value.size(); ++i) check(value[i], *type.items, {&place, {}, i});
}

}  // namespace

void check_message(const json& message, const Type& type, const std::vector<std::string_view>& beside) {
    if (!message.is_object()) refuse("the message is no JSON object");
    check(message, type, {});
    for (const auto& [name, value] : message.items()) {
        const bool is_known = std::ranges::find(beside, name) != beside.end() ||
                              std::ranges::find(type.members, name, &Type::Member::name) != type.members.end();
        if (!is_known) refuse(fmt::format("'{}' is not known here", name.substr(0, 64)));
    }
}

json parsed_request(std::string_view body, std::string_view type) {
    json request = parsed(body);
    check_message(request, *request_types().find(type)->second);
    return request;
}

}  // namespace kontur::viewer
