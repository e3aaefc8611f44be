// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/json_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

namespace kontur {
namespace {

using nlohmann::json;

[[noreturn]] void corrupt(const std::string& message) { throw Error(ErrorKind::corrupt_file, message); }

std::string read_text(const std::filesystem::path& path) {
    constexpr std::uintmax_t kLimit = std::uintmax_t{1} << 30;
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed) throw Error(ErrorKind::io, "cannot read " + path.string() + ": " + failed.message());
    if (size > kLimit)
        throw Error(ErrorKind::too_large,
                    fmt::format("{} has {} bytes; the limit for JSON is {}", path.string(), size, kLimit));
    std::ifstream file(path, std::ios::binary);
    std::string text(size, '\0');
    if (!file.read(text.data(), static_cast<std::streamsize>(size)))
        throw Error(ErrorKind::io, "cannot read " + path.string() + ": " + std::strerror(errno));
    return text;
}

/// Follows a parse only to know, when it fails, at which key and item. Run a second time on text that does not parse,
/// because the parser's own message gives no place for a number out of range.
class FailureLocator : public nlohmann::json_sax<json> {
public:
    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        levels_.back().key = name;
        return true;
    }
    bool parse_error(std::size_t byte, const std::string& token, const nlohmann::detail::exception& error) override {
        count();
        const bool overflow = dynamic_cast<const json::out_of_range*>(&error) != nullptr;
        message_ = overflow ? fmt::format("the number {} is out of range", token)
                            : fmt::format("is not valid JSON from byte {} on", byte);
        return false;
    }

    std::string message() const {
        constexpr std::size_t kDeepest = 8;  // files of ours have fewer; hostile ones have millions
        std::string place;
        bool after_key = false;
        for (const Level& level : std::span(levels_).first(std::min(levels_.size(), kDeepest))) {
            if (!level.is_array && level.key.empty()) continue;
            place += after_key && level.is_array ? " " : place.empty() ? " in " : ", ";
            place += !level.is_array ? level.key
                     : after_key     ? fmt::format("{}", level.items)
                                     : fmt::format("item {}", level.items);
            after_key = !level.is_array;
        }
        return message_ + place;
    }

private:
    struct Level {
        bool is_array;
        std::size_t items = 0;
        std::string key;
    };

    bool count() {
        if (!levels_.empty()) ++levels_.back().items;
        return true;
    }
    bool open(bool is_array) {
        count();
        levels_.push_back({is_array, 0, {}});
        return true;
    }
    bool close() {
        levels_.pop_back();
        return true;
    }

    std::vector<Level> levels_;
    std::string message_;
};

/// What a value is, with its article.
std::string_view kind_of(const json& value) {
    switch (value.type()) {
        case json::value_t::null:
            return "null";
        case json::value_t::object:
            return "an object";
        case json::value_t::array:
            return "an array";
        case json::value_t::string:
            return "text";
        case json::value_t::boolean:
            return "a truth value";
        default:
            return "a number";
    }
}

double to_number(const json& value, std::string_view what) {
    if (!value.is_number()) corrupt(fmt::format("{} is {}, not a number", what, kind_of(value)));
    return value.get<double>();
}

}  // namespace

json read_json_file(const std::filesystem::path& path) {
    const std::string text = read_text(path);
    try {
        return json::parse(text);
    } catch (const json::exception&) {
        FailureLocator locator;
        json::sax_parse(text, &locator);
        corrupt(path.string() + ": " + locator.message());
    }
}

const json& member(const json& object, const char* key) {
    if (!object.is_object()) corrupt(fmt::format("is {}, not an object with '{}'", kind_of(object), key));
    const auto found = object.find(key);
    if (found == object.end()) corrupt(fmt::format("'{}' is missing", key));
    return *found;
}

const json& array_member(const json& object, const char* key) {
    const json& value = member(object, key);
    if (!value.is_array()) corrupt(fmt::format("'{}' is {}, not an array", key, kind_of(value)));
    return value;
}

std::string text_member(const json& object, const char* key, const std::string& fallback) {
    if (!object.contains(key)) return fallback;
    const json& value = member(object, key);
    if (!value.is_string()) corrupt(fmt::format("'{}' is {}, not text", key, kind_of(value)));
    return value.get<std::string>();
}

double number_member(const json& object, const char* key, double fallback) {
    return object.contains(key) ? to_number(object[key], fmt::format("'{}'", key)) : fallback;
}

bool flag_member(const json& object, const char* key, bool fallback) {
    if (!object.contains(key)) return fallback;
    const json& value = member(object, key);
    if (!value.is_boolean()) corrupt(fmt::format("'{}' is {}, not true or false", key, kind_of(value)));
    return value.get<bool>();
}

std::string quoted(const json& value) {
    if (value.is_structured()) return std::string(kind_of(value));
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

Vec3 to_vec3(const json& value) {
    if (!value.is_array() || value.size() != 3)
        corrupt(value.is_array() ? fmt::format("has {} items, not the 3 numbers x, y, z", value.size())
                                 : fmt::format("is {}, not the 3 numbers x, y, z", kind_of(value)));
    return {to_number(value[0], "x"), to_number(value[1], "y"), to_number(value[2], "z")};
}

}  // namespace kontur
