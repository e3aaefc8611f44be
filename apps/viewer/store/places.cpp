// SPDX-License-Identifier: Apache-2.0
#include "viewer/store/places.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/dicom_drawings.h"
#include "kontur/io/dicom/dicom_series.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostListed = 2000;   ///< folders, and files: a page shows no more
constexpr std::size_t kMostFolders = 200;   ///< that are searched for DICOM below one
constexpr std::size_t kFilesOfFolder = 16;  ///< of each of them: slices come together
constexpr int kDeepest = 4;

constexpr std::array kImageEndings{".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha",    ".mhd",  ".mgz",
                                   ".mgh", ".mgh.gz", ".hdr",  ".img",  ".hdr.gz", ".gipl", ".gipl.gz"};

bool is_hidden(const fs::path& name) { return name.string().starts_with('.'); }

bool has_image_ending(const fs::path& file) {
    const std::string name = lower_case(file.filename().string());
    return std::ranges::any_of(kImageEndings, [&](const char* ending) { return name.ends_with(ending); });
}

bool is_dicom_file(const fs::path& file) {
    try {
        return looks_like_dicom(file);
    } catch (const Error&) {
        return false;  // it cannot be read
    }
}

/// Of a path below the place, whether a part of its way is hidden.
bool is_hidden_below(const fs::path& place, const fs::path& path) {
    const fs::path way = path.lexically_relative(place);
    return way != "." && std::any_of(way.begin(), way.end(), is_hidden);
}

bool is_below(const fs::path& place, const fs::path& path) {
    return std::mismatch(place.begin(), place.end(), path.begin(), path.end()).first == place.end();
}

std::int64_t seconds_since_1970(const fs::path& path) {
    std::error_code error;
    const auto written = fs::last_write_time(path, error);
    if (error) return 0;
    const auto system = std::chrono::file_clock::to_sys(written);
    return std::chrono::duration_cast<std::chrono::seconds>(system.time_since_epoch()).count();
}

/// What is in a folder and may be shown, each path without links.
struct Content {
    std::vector<Place> folders, files;
    std::size_t left_out = 0;
};

class Reader {
public:
    explicit Reader(const Places& places) : places_(places) {}

    Content read(const fs::path& folder) const {
        Content content;
        std::error_code failure;
        for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
            take(*entry, content);
        if (failure) throw Error(ErrorKind::io, fmt::format("cannot read {}: {}", folder.string(), failure.message()));
        for (auto* list : {&content.folders, &content.files})
            std::ranges::sort(*list, {}, [](const Place& one) { return std::pair(lower_case(one.name), one.name); });
        return content;
    }

private:
    void take(const fs::directory_entry& entry, Content& content) const {
        const fs::path name = entry.path().filename();
        if (is_hidden(name)) return;
        try {
            const fs::path path = places_.resolved(entry.path().string());
            std::error_code ignored;
            if (fs::is_directory(path, ignored)) content.folders.push_back({name.string(), path});
            else if (fs::is_regular_file(path, ignored)) content.files.push_back({name.string(), path});
        } catch (const Error&) {
            ++content.left_out;  // a link to nothing, or out of the places
        }
    }

    const Places& places_;
};

/// Looks at a few files of a few hundred folders: the nearest ones first.
bool has_dicom_below(const Reader& reader, const Content& start) {
    std::deque<std::pair<fs::path, int>> waiting;
    const auto add = [&](const Content& content, int depth) {
        for (const Place& folder : content.folders) waiting.emplace_back(folder.path, depth);
    };
    add(start, 1);
    for (std::size_t seen = 0; seen < kMostFolders && !waiting.empty(); ++seen) {
        const auto [folder, depth] = std::move(waiting.front());
        waiting.pop_front();
        try {
            const Content content = reader.read(folder);
            const auto last =
                content.files.begin() + static_cast<std::ptrdiff_t>(std::min(kFilesOfFolder, content.files.size()));
            if (std::any_of(content.files.begin(), last, [](const Place& file) { return is_dicom_file(file.path); }))
                return true;
            if (depth < kDeepest) add(content, depth + 1);
        } catch (const Error&) {
            continue;  // it cannot be read
        }
    }
    return false;
}

/// Empty for what cannot be opened by itself.
std::string kind_of(const fs::path& file) {
    if (lower_case(file.extension().string()) == ".kontur") return "project";
    if (has_image_ending(file)) return "image";
    if (!is_dicom_file(file)) return "";
    return dicom_drawing(file) ? "drawing" : "dicom";
}

/// "~" and "~/scans" as a shell reads them.
std::string without_tilde(const std::string& path) {
    const char* home = std::getenv("HOME");
    const bool is_of_home = path == "~" || path.starts_with("~/");
    return is_of_home && home ? home + path.substr(1) : path;
}

json entry_json(const Place& place) { return {{"name", place.name}, {"path", place.path.string()}}; }

json file_json(const Place& file, const std::string& kind) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file.path, error);
    json entry = entry_json(file);
    entry["kind"] = kind;
    entry["bytes"] = error ? 0 : bytes;
    entry["modified"] = seconds_since_1970(file.path);
    return entry;
}

/// As many entries as a page shows.
struct Listing {
    explicit Listing(std::size_t already) : left_out(already) {}

    void add(json& list, json entry) {
        if (list.size() < kMostListed) list.push_back(std::move(entry));
        else ++left_out;
    }

    json folders = json::array(), files = json::array();
    std::size_t left_out;
};

}  // namespace

Places::Places(const std::vector<Place>& places) {
    for (const Place& place : places) {
        std::error_code error;
        const fs::path path = fs::canonical(place.path, error);
        const bool is_known = std::ranges::any_of(places_, [&](const Place& known) { return known.path == path; });
        if (error || is_known || !fs::is_directory(path, error) || access(path.c_str(), R_OK | X_OK) != 0) continue;
        places_.push_back({place.name, path});
    }
}

fs::path Places::resolved(const std::string& typed) const {
    if (typed.find('\0') != std::string::npos)
        throw Error(ErrorKind::invalid_input,
                    "the path holds a NUL character, which no file's name can. Type the path again");
    const std::string path = without_tilde(typed);
    std::error_code error;
    const fs::path found = fs::canonical(path, error);
    // Whether something is there is told of places only.
    const fs::path way = error ? fs::weakly_canonical(path, error) : found;
    const bool is_inside = std::ranges::any_of(
        places_, [&](const Place& place) { return is_below(place.path, way) && !is_hidden_below(place.path, way); });
    if (!fs::path(path).is_absolute() || !is_inside)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{0} lies outside of the folders that this page may open. To open it here, "
                                "start kontur with it: kontur open {0}",
                                path));
    if (found.empty()) throw PathMissing(ErrorKind::io, fmt::format("cannot read {}: it does not exist", path));
    return found;
}

json Places::list(const std::string& path) const {
    const fs::path folder = resolved(path);
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored)) throw Error(ErrorKind::io, fmt::format("{} is no folder", path));
    const Reader reader(*this);
    const Content content = reader.read(folder);
    Listing listed(content.left_out);
    bool has_slices = false;
    for (const Place& one : content.folders) listed.add(listed.folders, entry_json(one));
    for (const Place& one : content.files) {
        const std::string kind = kind_of(one.path);
        has_slices = has_slices || kind == "dicom";
        if (kind == "image" || kind == "project" || kind == "drawing") listed.add(listed.files, file_json(one, kind));
    }
    return {{"path", folder.string()},
            {"name", folder.filename().string()},
            {"parent", parent_json(folder)},
            {"folders", listed.folders},
            {"files", listed.files},
            {"dicom", has_slices ? "here" : has_dicom_below(reader, content) ? "below" : "none"},
            {"left_out", listed.left_out}};
}

std::string Places::folder_of(const std::string& path) const {
    try {
        const fs::path found = resolved(path);
        std::error_code ignored;
        return (fs::is_directory(found, ignored) ? found : found.parent_path()).string();
    } catch (const Error&) {
        return {};
    }
}

json Places::parent_json(const fs::path& folder) const {
    const fs::path parent = folder.parent_path();
    if (parent == folder) return nullptr;
    try {
        return resolved(parent.string()).string();
    } catch (const Error&) {
        return nullptr;  // a place itself
    }
}

std::vector<Place> usual_places() {
    std::vector<Place> places;
    const auto add = [&](const std::string& name, const fs::path& path) {
        std::error_code ignored;
        if (path.is_absolute() && path.has_relative_path() && fs::is_directory(path, ignored))
            places.push_back({name, path});
    };
    std::error_code error;
    const fs::path here = fs::current_path(error);
    if (!error) add(here.filename().string(), here);
    if (const char* home = std::getenv("HOME")) add("Home", home);
    for (const char* mounts : {"/media", "/run/media", "/mnt"}) {
        const bool has_any =
            fs::is_directory(mounts, error) && fs::directory_iterator(mounts, error) != fs::directory_iterator();
        if (has_any) add(mounts, mounts);
    }
    return places;
}

}  // namespace kontur::viewer
