// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/image_files.h"

#include <array>
#include <string>
#include <string_view>

#include "kontur/base/printable.h"
#include "kontur/io/bytes/input_file.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/images/metaimage.h"
#include "kontur/io/images/nrrd.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// The other of two names of three letters, in capitals where the one is.
std::string other_spelling(std::string_view extension, std::string_view other) {
    std::string spelled(other);
    const bool capitals = extension.front() >= 'A' && extension.front() <= 'Z';
    for (char& c : spelled) c = static_cast<char>(capitals ? c - 'a' + 'A' : c);
    return spelled;
}

/// `stem` ends with the dot.
fs::path found_beside(const fs::path& folder, const std::string& stem, const std::string& extension,
                      const std::string& compression) {
    const fs::path same = folder / (stem + extension + compression);
    if (is_there(same)) return same;
    const fs::path other = folder / (stem + extension + (compression.empty() ? ".gz" : ""));
    return is_there(other) ? other : same;
}

}  // namespace

std::optional<ImagePair> image_pair(const fs::path& either) {
    std::string name = either.filename().string(), compression;
    if (lower_case(name).ends_with(".gz")) {
        compression = name.substr(name.size() - 3);
        name.resize(name.size() - 3);
    }
    const std::string small = lower_case(name);
    const bool is_header = small.ends_with(".hdr");
    if (!is_header && !small.ends_with(".img")) return std::nullopt;
    const std::string stem = name.substr(0, name.size() - 3), extension = name.substr(name.size() - 3);
    const fs::path other =
        found_beside(either.parent_path(), stem, other_spelling(extension, is_header ? "img" : "hdr"), compression);
    return is_header ? ImagePair{either, other} : ImagePair{other, either};
}

std::vector<fs::path> image_files(const fs::path& path) {
    const std::string name = lower_case(path.filename().string());
    const auto has = [&](std::string_view extension) { return name.ends_with(extension); };
    std::vector<fs::path> files{path};
    std::optional<std::string> voxels;
    if (const auto pair = image_pair(path)) files = {pair->header, pair->voxels};
    else if (has(".mhd") || has(".mha")) voxels = metaimage_data_file(path);
    else if (has(".nhdr") || has(".nrrd")) voxels = nrrd_data_file(path);
    if (voxels) files.push_back(path_beside(path, *voxels));
    if (files.size() > 1 && !is_there(files.back())) files.pop_back();
    return files;
}

}  // namespace kontur
