// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

// The DICOM JSON model (DICOM PS3.18, F): objects whose keys are tags such as "0020000D".

namespace kontur::archive {

/// The objects of an answer; none of an empty one. Throws Error(corrupt_file) unless it is an array of objects.
std::vector<nlohmann::json> json_objects(std::string_view text);

/// An object's values of a tag as printable text, a person's name in its alphabetic form; empty without them.
std::vector<std::string> values_of(const nlohmann::json& object, const char* tag);

/// The first of them, or "".
std::string value_of(const nlohmann::json& object, const char* tag);

/// The first of them as a number that counts something; 0 where it is none.
std::int64_t count_of(const nlohmann::json& object, const char* tag);

/// The items of a sequence; none where it is missing.
std::vector<nlohmann::json> items_of(const nlohmann::json& object, const char* tag);

}  // namespace kontur::archive
