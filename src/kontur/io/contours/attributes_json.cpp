// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/contours/attributes_json.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/json_file.h"
#include "kontur/io/contours/attributes_members.h"

namespace kontur {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

[[noreturn]] void corrupt(const std::string& message) { throw Error(ErrorKind::corrupt_file, message); }

std::array<std::uint8_t, 3> read_color(const json& value) {
    std::array<std::uint8_t, 3> color{};
    if (!value.is_array() || value.size() != color.size()) corrupt("is no list of red, green and blue");
    for (std::size_t n = 0; n < color.size(); ++n) {
        if (!value[n].is_number_integer() || value[n] < 0 || value[n] > 255)
            corrupt(fmt::format("has the level {}; whole numbers from 0 to 255 are possible", quoted(value[n])));
        color[n] = value[n].get<std::uint8_t>();
    }
    return color;
}

std::int64_t read_number(const json& value) {
    const bool is_too_large = value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX;
    if (!value.is_number_integer() || is_too_large) corrupt(fmt::format("is {}, not a whole number", quoted(value)));
    return value.get<std::int64_t>();
}

CodedConcept read_code(const json& value) {
    CodedConcept code{text_member(value, "value", ""), text_member(value, "scheme", ""), text_member(value, "meaning", "")};
    if (code.value.empty() || code.scheme.empty()) corrupt("has no value or no scheme");
    return code;
}

std::vector<PhysicalProperty> read_properties(const json& list) {
    std::vector<PhysicalProperty> properties;
    if (!list.is_array()) corrupt("is no list");
    for_each_item(list, "item", [&](const json& item) {
        const json& value = member(item, "value");
        if (!value.is_number()) corrupt(fmt::format("the value is {}, not a number", quoted(value)));
        properties.push_back({text_member(item, "property", ""), value.get<double>()});
        if (properties.back().property.empty()) corrupt("has no 'property'");
    });
    return properties;
}

/// As in "2026-11-30T21:02:43".
bool is_local_time(const std::string& text) {
    constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:dd";
    return std::ranges::equal(text, kForm, [](char c, char form) { return form == 'd' ? c >= '0' && c <= '9' : c == form; });
}

Approval read_approval(const json& value) {
    if (!value.is_object()) corrupt("is no object");
    const Approval approval{text_member(value, "by", ""), text_member(value, "at", "")};
    if (!approval.at.empty() && !is_local_time(approval.at))
        corrupt(fmt::format("'at' is {}, not a time like 2026-11-30T21:02:43", quoted(value["at"])));
    return approval;
}

Review read_review(const json& value) {
    if (!value.is_object()) corrupt("is no object");
    Review review{.comment = text_member(value, "comment", ""), .locked = flag_member(value, "locked", false)};
    if (value.contains("approved"))
        review.approved = in_context("approved", [&] { return read_approval(value["approved"]); });
    return review;
}

ordered_json to_object(const Review& review) {
    ordered_json object = ordered_json::object();
    if (review.approved) object["approved"] = {{"by", review.approved->by}, {"at", review.approved->at}};
    if (!review.comment.empty()) object["comment"] = review.comment;
    if (review.locked) object["locked"] = true;
    return object;
}

ordered_json to_object(const CodedConcept& code) {
    return {{"value", code.value}, {"scheme", code.scheme}, {"meaning", code.meaning}};
}

ordered_json to_object(const PhysicalProperty& one) {
    if (!std::isfinite(one.value))
        throw Error(ErrorKind::invalid_input, fmt::format("the physical property '{}' is NaN or infinite", one.property));
    return {{"property", one.property}, {"value", one.value}};
}

void check_texts(const StructureAttributes& a) {
    for (const std::string* text : {&a.interpreted_type, &a.generation_algorithm, &a.description})
        check_utf8(*text, "what is said of a structure,");
    check_utf8(a.review.comment, "a comment");
    if (a.review.approved) check_utf8(a.review.approved->by, "the name of who approved");
    for (const auto* code : {&a.category, &a.code})
        if (*code)
            for (const std::string* text : {&(*code)->value, &(*code)->scheme, &(*code)->meaning})
                check_utf8(*text, "a code");
    for (const PhysicalProperty& one : a.physical_properties) check_utf8(one.property, "a physical property");
}

}  // namespace

StructureAttributes read_attributes(const json& document) {
    StructureAttributes attributes;
    const auto read = [&](const char* key, auto& value, const auto& reader) {
        if (document.contains(key)) value = in_context(key, [&] { return reader(document[key]); });
    };
    read("color", attributes.color, read_color);
    attributes.interpreted_type = text_member(document, "interpreted_type", "");
    attributes.generation_algorithm = text_member(document, "generation_algorithm", "");
    attributes.description = text_member(document, "description", "");
    read("number", attributes.number, read_number);
    read("category", attributes.category, read_code);
    read("code", attributes.code, read_code);
    read("physical_properties", attributes.physical_properties, read_properties);
    read("review", attributes.review, read_review);
    return attributes;
}

ordered_json attribute_members(const StructureAttributes& attributes) {
    check_texts(attributes);
    ordered_json all = ordered_json::object();
    if (attributes.number) all["number"] = *attributes.number;
    if (!attributes.interpreted_type.empty()) all["interpreted_type"] = attributes.interpreted_type;
    if (attributes.color) all["color"] = *attributes.color;
    if (!attributes.description.empty()) all["description"] = attributes.description;
    if (!attributes.generation_algorithm.empty()) all["generation_algorithm"] = attributes.generation_algorithm;
    if (attributes.category) all["category"] = to_object(*attributes.category);
    if (attributes.code) all["code"] = to_object(*attributes.code);
    for (const PhysicalProperty& one : attributes.physical_properties) all["physical_properties"].push_back(to_object(one));
    if (attributes.review != Review{}) all["review"] = to_object(attributes.review);
    return all;
}

std::string to_json(const StructureAttributes& attributes) { return attribute_members(attributes).dump(); }

StructureAttributes attributes_from_json(std::string_view text) { return read_attributes(parse_json(text)); }

}  // namespace kontur
