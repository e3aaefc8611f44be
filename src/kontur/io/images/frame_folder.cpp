// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/images/frame_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/natural_order.h"
#include "kontur/base/printable.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// Each of one file: an .img belongs to its .hdr.
constexpr std::array kEndings{".nii", ".nii.gz", ".hdr", ".hdr.gz", ".nrrd",    ".nhdr", ".mha",
                              ".mhd", ".mgz",    ".mgh", ".mgh.gz", ".gipl.gz", ".gipl"};

bool is_frame_name(const std::string& name) {
    const std::string small = lower_case(name);
    const auto has = [&](const char* ending) { return small.ends_with(ending); };
    return !small.starts_with('.') && !has(".seg.nrrd") && std::ranges::any_of(kEndings, has);
}

std::string voxels_of(const Grid& grid) { return fmt::format("{} x {} x {}", grid.size.i, grid.size.j, grid.size.k); }

}  // namespace

std::vector<fs::path> frame_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failure, ignored;
    if (!fs::is_directory(folder, ignored)) return files;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
        if (entry->is_regular_file(ignored) && is_frame_name(entry->path().filename().string()))
            files.push_back(entry->path());
    if (failure) throw Error(ErrorKind::io, fmt::format("cannot read {}: {}", folder.string(), failure.message()));
    std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
        return comes_before(a.filename().string(), b.filename().string());
    });
    return files;
}

Grid grid_of_frames(const std::vector<fs::path>& files, const std::function<Grid(const fs::path&)>& read) {
    constexpr double kSameGrid = 1e-3;  // NIfTI's floats round 100 mm by 4e-6; a shift of a tenth of a voxel is meant
    const fs::path& first = files.front();
    const Grid grid = read(first);
    const Vec3 spacing = grid.spacing_mm();
    const double most_mm = kSameGrid * std::min({spacing.x, spacing.y, spacing.z});
    for (const fs::path& file : files) {
        const Grid other = read(file);
        const std::string both = fmt::format("{}: {} and {} are no frames of one image", first.parent_path().string(),
                                             first.filename().string(), file.filename().string());
        constexpr const char* kWay = "frames need one grid; name one file, or move what is no frame elsewhere";
        if (other.size != grid.size)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{}: they have {} and {} voxels; {}", both, voxels_of(grid), voxels_of(other), kWay));
        if (const double apart = corner_distance_mm(grid, other); !(apart <= most_mm))
            throw Error(
                ErrorKind::invalid_input,
                fmt::format("{}: their corners lie {:.3g} mm apart, more than {:.1g} mm; {}", both, apart, most_mm, kWay));
    }
    return grid;
}

}  // namespace kontur
