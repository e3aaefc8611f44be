// SPDX-License-Identifier: Apache-2.0
#include "outputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& reason) {
    throw Error(ErrorKind::io, fmt::format("cannot write {}: {}", target.string(), reason));
}

/// Where a symbolic link leads, so that the link stays and what it names is replaced.
fs::path resolved(const fs::path& target) {
    std::error_code error;
    const fs::path path = fs::weakly_canonical(fs::absolute(target), error);
    return error ? fs::absolute(target) : path;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

}  // namespace

void check_output(const fs::path& target, std::span<const fs::path> inputs) {
    const fs::path path = resolved(target);
    const fs::path folder = path.parent_path();
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) fail(target, fmt::format("the folder {} does not exist", folder.string()));
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) fail(target, "it is no regular file");
    for (const fs::path& input : inputs)
        if (fs::equivalent(path, input, ignored))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is an input, which an output may not replace", target.string()));
    if (access(folder.c_str(), W_OK) != 0) fail(target, std::generic_category().message(errno));
}

Outputs::~Outputs() {
    std::error_code ignored;
    for (const auto& [folder, hidden] : folders_) fs::remove_all(hidden, ignored);
    if (!created_folder_.empty()) fs::remove(created_folder_, ignored);
}

void Outputs::create_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::create_directory(folder, error)) created_folder_ = folder;
    else if (error) fail(folder, error.message());
}

void Outputs::write(const fs::path& target, const std::function<void(const fs::path&)>& writer) {
    const fs::path path = resolved(target);
    const fs::path temporary = staging_folder(path.parent_path()) / path.filename();
    files_[path] = temporary;
    try {
        writer(temporary);
    } catch (const Error& error) {
        throw Error(error.kind(), replaced(error.what(), temporary.string(), target.string()));
    }
}

fs::path Outputs::staging_folder(const fs::path& folder) {
    if (const auto known = folders_.find(folder); known != folders_.end()) return known->second;
    std::string hidden = (folder / ".kontur-XXXXXX").string();
    if (!mkdtemp(hidden.data())) fail(folder, std::generic_category().message(errno));
    return folders_[folder] = hidden;
}

void Outputs::commit() {
    for (const auto& [target, temporary] : files_) {
        std::error_code error;
        if (fs::exists(target, error)) fs::permissions(temporary, fs::status(target).permissions(), error);
        fs::rename(temporary, target, error);
        if (error) fail(target, error.message());
    }
    created_folder_.clear();
}

}  // namespace kontur::app
