// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/arrangements.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "viewer/model/model_json.h"
#include "viewer/model/temporary_files.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kLargestState = 4096;
constexpr std::size_t kMostModalities = 100;
constexpr std::uintmax_t kLargestFile = 1 << 20;
constexpr std::size_t kLongestCode = 16;  // of a code string (DICOM PS3.5, table 6.2-1)

bool is_code(const std::string& text) {
    return text.size() <= kLongestCode && std::ranges::all_of(text, [](char c) {
               return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == ' ';
           });
}

}  // namespace

Arrangements::Arrangements(fs::path file) : file_(std::move(file)) {}

json Arrangements::stored() const {
    std::error_code error;
    if (file_.empty() || fs::file_size(file_, error) > kLargestFile || error) return json::object();
    try {
        json all = parsed(read_bytes(file_));
        return all.is_object() ? all : json::object();
    } catch (const json::exception&) {
        return json::object();
    } catch (const Error&) {
        return json::object();
    }
}

json Arrangements::of(const std::string& modality) const {
    const std::scoped_lock lock(mutex_);
    return stored().value(modality, json());
}

void Arrangements::keep(const std::string& modality, const json& state) {
    if (!is_code(modality)) throw Error(ErrorKind::invalid_input, fmt::format("'{}' is no modality", modality));
    const std::size_t bytes = to_text(state).size();
    if (bytes > kLargestState)
        throw Error(ErrorKind::too_large, fmt::format("'state' has {} bytes; the limit is {}", bytes, kLargestState));
    if (file_.empty()) return;
    const std::scoped_lock lock(mutex_);
    json all = stored();
    if (all.size() >= kMostModalities) all = json::object();
    all[modality] = state;
    try {
        write_file_atomically(file_, to_text(all) + "\n");
    } catch (const Error&) {
        return;
    }
}

}  // namespace kontur::viewer
