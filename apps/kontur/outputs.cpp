// SPDX-License-Identifier: Apache-2.0
#include "outputs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <set>
#include <string_view>
#include <system_error>

#include "files.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& target, const std::string& reason) {
    throw Error(ErrorKind::io, fmt::format("cannot write {}: {}", target.string(), reason));
}

[[noreturn]] void refuse(const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); }

[[noreturn]] void refuse_second(const fs::path& target) {
    refuse(fmt::format("{} is named for two outputs; each needs a file of its own", target.string()));
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

/// A second name, so that the target is there at any time; a move where the file system or its rules know no second names.
void keep(const fs::path& target, const fs::path& kept, std::error_code& error) {
    fs::create_hard_link(target, kept, error);
    if (error) fs::rename(target, kept, error);
}

constexpr std::string_view kHiddenStem = ".kontur-";
constexpr std::string_view kKeptStem = ".replaced-";

/// A lock on a folder, which the system takes back when the process ends, however it does; -1 where another holds it, or the
/// file system has no locks on folders.
int lock_folder(const fs::path& folder, int how) {
    const int opened = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (opened < 0 || flock(opened, LOCK_EX | how) == 0) return opened;
    close(opened);
    return -1;
}

bool keeps_a_file(const fs::path& hidden) {
    std::error_code error;
    for (fs::directory_iterator at(hidden, error), end; !error && at != end; at.increment(error))
        if (at->path().filename().string().starts_with(kKeptStem)) return true;
    return static_cast<bool>(error);
}

/// As mkdtemp makes it for this user.
bool is_ours(int folder) {
    struct stat status {};
    return fstat(folder, &status) == 0 && status.st_uid == geteuid() && (status.st_mode & 07777) == 0700;
}

/// Removes the hidden folders of runs that were killed; not those that keep what stood at a target.
void clear_leftovers(const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (name.size() != kHiddenStem.size() + 6 || !name.starts_with(kHiddenStem)) continue;
        const int lock = lock_folder(at->path(), LOCK_NB);
        if (lock < 0) continue;
        std::error_code ignored;
        if (is_ours(lock) && !keeps_a_file(at->path())) fs::remove_all(at->path(), ignored);
        close(lock);
    }
}

}  // namespace

fs::path destination(const fs::path& target) {
    const fs::path path = fs::absolute(link_destination(target));
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(path, error);
    return error ? path : canonical;
}

void check_output(const fs::path& target, std::span<const fs::path> inputs) {
    if (target.empty()) return;
    const fs::path path = destination(target);
    const fs::path folder = path.parent_path();
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) fail(target, fmt::format("the folder {} does not exist", folder.string()));
    if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) fail(target, "it is no regular file");
    for (const fs::path& input : inputs) {
        if (fs::equivalent(path, input, ignored))
            refuse(fmt::format("{} is an input, which an output may not replace", target.string()));
        if (is_within(folder, series_folder(input)) && is_dicom_slice(path))
            refuse(fmt::format("{} is a slice of the input {}, which an output may not replace", target.string(),
                               input.string()));
    }
    const bool is_protected = fs::exists(path, ignored) && access(path.c_str(), W_OK) != 0;
    if (is_protected || access(folder.c_str(), W_OK) != 0) fail(target, std::generic_category().message(errno));
}

void check_outputs(std::span<const fs::path> targets, std::span<const fs::path> inputs) {
    std::set<fs::path> known;
    for (const fs::path& target : targets) {
        check_output(target, inputs);
        if (!target.empty() && !known.insert(destination(target)).second) refuse_second(target);
    }
}

Outputs::~Outputs() {
    std::error_code ignored;
    for (const auto& [folder, hidden] : folders_) fs::remove_all(hidden, ignored);
    for (const int lock : locks_) close(lock);
    if (!created_folder_.empty()) fs::remove(created_folder_, ignored);
}

void Outputs::create_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::create_directory(folder, error)) created_folder_ = folder;
    else if (error) fail(folder, error.message());
}

void Outputs::write(const fs::path& target, const std::function<void(const fs::path&)>& writer) {
    const fs::path path = destination(target);
    const fs::path temporary = staging_folder(path.parent_path()) / path.filename();
    if (!files_.emplace(path, temporary).second) refuse_second(target);
    try {
        writer(temporary);
    } catch (const Error& error) {
        throw Error(error.kind(), replaced(error.what(), temporary.string(), target.string()));
    }
}

fs::path Outputs::staging_folder(const fs::path& folder) {
    if (const auto known = folders_.find(folder); known != folders_.end()) return known->second;
    clear_leftovers(folder);
    for (;;) {
        std::string hidden = (folder / fmt::format("{}XXXXXX", kHiddenStem)).string();
        if (!mkdtemp(hidden.data())) fail(folder, std::generic_category().message(errno));
        const int lock = lock_folder(hidden, 0);
        if (lock >= 0) locks_.push_back(lock);
        // Another run may have taken it for a leftover before it was locked.
        if (std::error_code ignored; fs::exists(hidden, ignored)) return folders_[folder] = hidden;
    }
}

void Outputs::commit() {
    std::vector<PreviousFile> before;
    for (const auto& [target, temporary] : files_) {
        std::error_code error;
        const bool is_new = !fs::exists(target, error);
        if (!is_new) {
            fs::permissions(temporary, fs::status(target).permissions(), error);
            const PreviousFile old{target, temporary.parent_path() / fmt::format("{}{}", kKeptStem, before.size())};
            keep(old.target, old.kept, error);
            if (!error) before.push_back(old);
        }
        if (!error) fs::rename(temporary, target, error);
        if (error) {
            take_back(before);
            fail(target, error.message());
        }
        if (is_new) before.push_back({target, {}});
    }
    created_folder_.clear();
}

void Outputs::take_back(std::vector<PreviousFile>& before) {
    for (; !before.empty(); before.pop_back()) {
        const auto& [target, kept] = before.back();
        std::error_code error;
        if (kept.empty()) fs::remove(target, error);
        else fs::rename(kept, target, error);
        if (error) folders_.erase(target.parent_path());  // rather a hidden folder left than what it keeps lost
    }
}

}  // namespace kontur::app
