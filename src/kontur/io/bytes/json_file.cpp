// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/bytes/json_file.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/check_json.h"
#include "kontur/io/bytes/input_file.h"

namespace kontur {
namespace {

using nlohmann::json;

[[noreturn]] void corrupt(const std::string& message) { throw Error(ErrorKind::corrupt_file, message); }

std::string read_text(const std::filesystem::path& path) {
    constexpr std::uint64_t kLimit = std::uint64_t{1} << 30;
    InputFile file(path);
    const std::uint64_t size = file.stored_bytes_left();
    if (size > kLimit)
        throw Error(ErrorKind::too_large,
                    fmt::format("{} has {} bytes; the limit for JSON is {}", path.string(), size, kLimit));
    std::string text(size, '\0');
    file.read(text.data(), text.size());
    return text;
}

/// Builds the document and knows, when that fails, at which key and item: the parser's own message gives no place for a
/// number out of range, and a document that is built already does not tell of a key that stood in it twice.
class DocumentReader : public nlohmann::json_sax<json> {
public:
    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t& value) override { return add(std::move(value)); }
    bool start_object(std::size_t) override { return open(json::value_t::object); }
    bool start_array(std::size_t) override { return open(json::value_t::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        Level& level = levels_.back();
        auto& members = level.value->get_ref<json::object_t&>();
        const auto [member, is_new] = members.try_emplace(name);
        level.key = is_new ? name : "";
        level.member = &member->second;
        if (!is_new) message_ = fmt::format("the key \"{}\" stands there twice", shortened(name, kMostQuoted));
        return is_new;
    }
    bool parse_error(std::size_t byte, const std::string& token, const nlohmann::detail::exception& error) override {
        count();
        const bool overflow = dynamic_cast<const json::out_of_range*>(&error) != nullptr;
        message_ = overflow ? fmt::format("the number {} is out of range", token)
                            : fmt::format("is not valid JSON from byte {} on", byte);
        return false;
    }

    json take() { return std::move(root_); }

    std::string message() const {
        constexpr std::size_t kDeepest = 8;  // files of ours have fewer; hostile ones have millions
        std::string place;
        bool after_key = false;
        for (const Level& level : std::span(levels_).first(std::min(levels_.size(), kDeepest))) {
            if (!level.is_array() && level.key.empty()) continue;
            place += after_key && level.is_array() ? " " : place.empty() ? " in " : ", ";
            place += !level.is_array() ? level.key
                     : after_key       ? fmt::format("{}", level.items)
                                       : fmt::format("item {}", level.items);
            after_key = !level.is_array();
        }
        return message_ + place;
    }

private:
    static constexpr std::size_t kMostQuoted = 64;

    struct Level {
        json* value;  ///< stays where it is as long as it is open: its parent grows only behind it
        std::size_t items = 0;
        std::string key{};
        json* member = nullptr;  ///< of an object, the value that the next event gives

        bool is_array() const { return value->is_array(); }
    };

    void count() {
        if (!levels_.empty()) ++levels_.back().items;
    }
    json* place(json&& value) {
        count();
        if (levels_.empty()) return &(root_ = std::move(value));
        Level& level = levels_.back();
        if (!level.is_array()) return &(*level.member = std::move(value));
        return &level.value->get_ref<json::array_t&>().emplace_back(std::move(value));
    }
    template <class Value>
    bool add(Value&& value) {
        place(json(std::forward<Value>(value)));
        return true;
    }
    bool open(json::value_t type) {
        levels_.push_back({place(json(type))});
        return true;
    }
    bool close() {
        levels_.pop_back();
        return true;
    }

    json root_;
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

json parse_json(std::string_view text) {
    DocumentReader reader;
    if (!json::sax_parse(text, &reader)) corrupt(reader.message());
    return reader.take();
}

json read_json_file(const std::filesystem::path& path) {
    const std::string text = read_text(path);
    try {
        return parse_json(text);
    } catch (const Error& error) {
        throw error.with_context(path.string());
    }
}

void check_json(std::string_view text) { parse_json(text); }

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
