// SPDX-License-Identifier: Apache-2.0
#include "archive/dicom_json.h"

#include <fmt/format.h>

#include <charconv>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/check_json.h"

namespace kontur::archive {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValueBytes = 1024;  // what a name or a description may have, and more

const json* values(const json& object, const char* tag) {
    const auto element = object.find(tag);
    if (element == object.end() || !element->is_object()) return nullptr;
    const auto value = element->find("Value");
    return value == element->end() || !value->is_array() ? nullptr : &*value;
}

std::string text_of(const json& value) {
    if (value.is_string()) return shortened(value.get_ref<const std::string&>(), kMostValueBytes);
    if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
    if (value.is_number()) return fmt::format("{}", value.get<double>());
    const auto alphabetic = value.is_object() ? value.find("Alphabetic") : value.end();
    if (!value.is_object() || alphabetic == value.end() || !alphabetic->is_string()) return "";
    return shortened(alphabetic->get_ref<const std::string&>(), kMostValueBytes);
}

}  // namespace

std::vector<json> json_objects(std::string_view text) {
    if (text.empty()) return {};
    try {
        check_json(text);
    } catch (const Error& error) {
        throw error.with_context("the archive's answer is no JSON");
    }
    json found = json::parse(text);
    if (found.is_object()) return {std::move(found)};
    std::vector<json> objects;
    if (found.is_array())
        for (json& one : found)
            if (one.is_object()) objects.push_back(std::move(one));
    if (!found.is_array() || objects.size() != found.size())
        throw Error(ErrorKind::corrupt_file, "the archive's answer is JSON, but no list of DICOM objects");
    return objects;
}

std::vector<std::string> values_of(const json& object, const char* tag) {
    std::vector<std::string> texts;
    if (const json* found = values(object, tag))
        for (const json& value : *found)
            if (std::string text = text_of(value); !text.empty()) texts.push_back(std::move(text));
    return texts;
}

std::string value_of(const json& object, const char* tag) {
    const std::vector<std::string> texts = values_of(object, tag);
    return texts.empty() ? "" : texts.front();
}

std::int64_t count_of(const json& object, const char* tag) {
    const std::string text = value_of(object, tag);
    std::int64_t count = 0;
    std::from_chars(text.data(), text.data() + text.size(), count);
    return count < 0 ? 0 : count;
}

std::vector<json> items_of(const json& object, const char* tag) {
    std::vector<json> items;
    if (const json* found = values(object, tag))
        for (const json& item : *found)
            if (item.is_object()) items.push_back(item);
    return items;
}

}  // namespace kontur::archive
