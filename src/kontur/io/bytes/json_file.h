// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal to io: how its JSON readers get at values so that every refusal names the place. Not part of the public API.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "kontur/base/error.h"
#include "kontur/base/geometry.h"

namespace kontur {

/// The text's content. Throws Error(corrupt_file) for what is no JSON, a number beyond double's range and a key that stands
/// twice in one object, of which every program keeps another; the message says at which key and item, counted from 1.
nlohmann::json parse_json(std::string_view text);

/// The file's content. Errors name the file: io (cannot be read, no regular file), too_large (over 1 GiB) and those of
/// `parse_json`.
nlohmann::json read_json_file(const std::filesystem::path& path);

/// The member `key` of an object. Throws Error(corrupt_file) when it is missing, or when `object` is none.
const nlohmann::json& member(const nlohmann::json& object, const char* key);

/// The member `key`, which must be an array.
const nlohmann::json& array_member(const nlohmann::json& object, const char* key);

/// The member `key` as text, truth value or number, or `fallback` when it is absent. Another type is an Error(corrupt_file).
std::string text_member(const nlohmann::json& object, const char* key, const std::string& fallback);
double number_member(const nlohmann::json& object, const char* key, double fallback);
bool flag_member(const nlohmann::json& object, const char* key, bool fallback);

/// The value as a message quotes it: itself when it is no array and no object, whose depth has no limit, else what it is.
std::string quoted(const nlohmann::json& value);

/// An array of exactly three numbers.
Vec3 to_vec3(const nlohmann::json& value);

/// `body(item)` for every item; an Error that leaves it gains the context "WHAT NUMBER", counted from 1.
template <class Body>
void for_each_item(const nlohmann::json& array, std::string_view what, Body body) {
    std::size_t number = 0;
    for (const nlohmann::json& item : array) {
        ++number;
        try {
            body(item);
        } catch (const Error& error) {
            throw error.with_context(fmt::format("{} {}", what, number));
        }
    }
}

/// The result of `body()`; an Error that leaves it gains the context.
template <class Body>
auto in_context(const std::string& context, Body body) {
    try {
        return body();
    } catch (const Error& error) {
        throw error.with_context(context);
    }
}

}  // namespace kontur
