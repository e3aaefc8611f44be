// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace kontur::viewer {

/// A project that was worked on.
struct RecentProject {
    std::filesystem::path project;
    std::string title;     ///< of its image: file, or patient and series
    std::string image;     ///< where it was
    std::string time;      ///< of the last opening, UTC, as 2026-11-23T17:30:00Z
    std::string second{};  ///< title of the image beside it, or ""
};

/// The projects that were opened last, in a file that only the user may read: titles can name patients. Safe for concurrent
/// use in one process; of two that write at a time the later one's list stays.
class RecentProjects {
public:
    /// An empty path: nothing is kept.
    explicit RecentProjects(std::filesystem::path file = {});

    /// The latest first. Projects that are not in their place any more are left out, and so is a list that cannot be read.
    std::vector<RecentProject> all() const;
    /// Best effort: a list that cannot be written keeps nobody from work.
    void add(RecentProject project);
    bool contains(const std::filesystem::path& project) const;

private:
    std::vector<RecentProject> stored() const;

    std::filesystem::path file_;
    mutable std::mutex mutex_;
};

}  // namespace kontur::viewer
