// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/recent.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "viewer/model/model_json.h"
#include "viewer/model/temporary_files.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostKept = 30;
constexpr std::size_t kLongestText = 4096;
constexpr std::uintmax_t kLargestFile = 1 << 20;

std::string now() {
    const auto seconds = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

}  // namespace

RecentProjects::RecentProjects(fs::path file) : file_(std::move(file)) {}

std::vector<RecentProject> RecentProjects::stored() const {
    std::vector<RecentProject> projects;
    std::error_code error;
    if (file_.empty() || fs::file_size(file_, error) > kLargestFile || error) return projects;
    try {
        for (const json& item : parsed(read_bytes(file_))) {
            const Members m(item);
            projects.push_back({m.text("project", kLongestText), m.text("title", kLongestText),
                                m.text("image", kLongestText), m.text("time", 32),
                                m.has("second") ? m.text("second", kLongestText) : ""});
            if (projects.size() == kMostKept) break;
        }
    } catch (const json::exception&) {
        projects.clear();
    } catch (const Error&) {
        projects.clear();
    }
    return projects;
}

std::vector<RecentProject> RecentProjects::all() const {
    const std::scoped_lock lock(mutex_);
    std::vector<RecentProject> projects = stored();
    std::erase_if(projects, [](const RecentProject& one) {
        std::error_code ignored;
        return !fs::is_regular_file(one.project, ignored);
    });
    return projects;
}

void RecentProjects::add(RecentProject project) {
    if (file_.empty()) return;
    const std::scoped_lock lock(mutex_);
    project.time = now();
    std::vector<RecentProject> projects = stored();
    std::erase_if(projects, [&](const RecentProject& one) { return one.project == project.project; });
    projects.insert(projects.begin(), std::move(project));
    if (projects.size() > kMostKept) projects.resize(kMostKept);
    json array = json::array();
    for (const RecentProject& one : projects)
        array.push_back({{"project", one.project.string()},
                         {"title", one.title},
                         {"image", one.image},
                         {"second", one.second},
                         {"time", one.time}});
    try {
        write_file_atomically(file_, to_text(array) + "\n");
        fs::permissions(file_, fs::perms::owner_read | fs::perms::owner_write);
    } catch (const Error&) {
        return;
    } catch (const fs::filesystem_error&) {
        return;
    }
}

bool RecentProjects::contains(const fs::path& project) const {
    for (const RecentProject& one : all())
        if (one.project == project) return true;
    return false;
}

}  // namespace kontur::viewer
