// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "kontur/base/error.h"
#include "kontur/io/dicom_grid.h"
#include "kontur/io/dicom_header.h"
#include "kontur/io/dicom_pixels.h"
#include "kontur/io/dicom_stack.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kVolumesListed = 20;

using LeftOut = std::map<std::string, std::vector<std::string>>;  ///< file names by reason

/// Regular files in order of their names, so that nothing depends on how the file system lists them.
struct FolderFiles {
    std::vector<fs::path> files;
    LeftOut unreachable;  ///< links in a circle
};

FolderFiles files_in(const fs::path& folder) {
    FolderFiles found;
    std::error_code failure, unreachable;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
        if (entry->is_regular_file(unreachable)) found.files.push_back(entry->path());
        if (unreachable && unreachable != std::errc::no_such_file_or_directory)
            found.unreachable[unreachable.message()].push_back(entry->path().filename().string());
    }
    if (failure) throw Error(ErrorKind::io, fmt::format("{}: {}", folder.string(), failure.message()));
    std::sort(found.files.begin(), found.files.end());
    for (auto& [reason, names] : found.unreachable) std::sort(names.begin(), names.end());
    return found;
}

struct FolderContent {
    std::vector<DicomStack> stacks;
    std::vector<std::string> notes;
    std::vector<DamagedImage> damaged;
};

FolderContent read_folder(const fs::path& folder, const Progress& progress) {
    std::vector<DicomHeader> headers;
    std::vector<DamagedImage> damaged;
    auto [files, left_out] = files_in(folder);
    for (std::size_t n = 0; n < files.size(); ++n) {
        progress.report("read headers", static_cast<double>(n) / static_cast<double>(files.size()));
        auto content = read_dicom_headers(files[n]);
        if (auto* slices = std::get_if<std::vector<DicomHeader>>(&content))
            std::move(slices->begin(), slices->end(), std::back_inserter(headers));
        else if (auto* image = std::get_if<DamagedImage>(&content)) damaged.push_back(std::move(*image));
        else left_out[std::get<NotAnImage>(content).reason].push_back(files[n].filename().string());
    }
    FolderContent result{group_into_stacks(std::move(headers)), {}, std::move(damaged)};
    for (const auto& [reason, names] : left_out)
        result.notes.push_back(fmt::format("left out {} file{} ({}): {}{}", names.size(), names.size() == 1 ? "" : "s",
                                           reason, names.front(), names.size() == 1 ? "" : ", ..."));
    return result;
}

DicomSeries describe(const DicomStack& stack) {
    const DicomHeader& first = stack.slices.front();
    DicomSeries series;
    series.series_uid = first.series_uid;
    series.modality = first.modality;
    series.description = first.description;
    series.distinction = stack.distinction;
    const bool agree = std::all_of(stack.slices.begin(), stack.slices.end(), [&](const DicomHeader& slice) {
        return slice.frame_of_reference_uid == first.frame_of_reference_uid;
    });
    if (agree) series.frame_of_reference_uid = first.frame_of_reference_uid;
    series.columns = first.columns;
    series.rows = first.rows;
    for (const DicomHeader& slice : stack.slices) {
        series.files.push_back(slice.path);
        series.frames.push_back(slice.frame.value_or(1));
    }
    return series;
}

std::string listed(const std::vector<DicomStack>& stacks) {
    std::string text;
    std::map<std::string, int> volume_of_series;
    for (std::size_t n = 0; n < stacks.size(); ++n) {
        const DicomSeries series = describe(stacks[n]);
        const int volume = ++volume_of_series[series.series_uid];
        if (n == kVolumesListed) text += fmt::format("; and {} more", stacks.size() - n);
        if (n >= kVolumesListed) continue;
        text += fmt::format("{}{} volume {} ({}{}, {} slices of {} x {}{})", n == 0 ? "" : "; ", series.series_uid, volume,
                            series.modality, series.description.empty() ? "" : " '" + series.description + "'",
                            series.files.size(), series.columns, series.rows,
                            series.distinction.empty() ? "" : ", " + series.distinction);
    }
    return text;
}

bool contains_file(const DicomStack& stack, const fs::path& file) {
    return std::any_of(stack.slices.begin(), stack.slices.end(),
                       [&](const DicomHeader& slice) { return slice.path.filename() == file.filename(); });
}

/// Narrows by a condition; throws when nothing is left.
template <typename Condition>
void keep(std::vector<DicomStack>& stacks, const std::string& what, const Condition& condition) {
    const std::string all = listed(stacks);
    std::erase_if(stacks, [&](const DicomStack& stack) { return !condition(stack); });
    if (stacks.empty()) throw Error(ErrorKind::invalid_input, fmt::format("there is no {}; there are: {}", what, all));
}

std::string series_of(const DicomStack& stack) { return stack.slices.front().series_uid; }

/// A file stands for its series and, unless a volume was asked for, for its volume.
void keep_own_of_file(std::vector<DicomStack>& stacks, const fs::path& file, const DicomSeriesOptions& options) {
    std::vector<DicomStack> own = stacks;
    keep(own, "volume with the file " + file.filename().string(),
         [&](const DicomStack& stack) { return contains_file(stack, file); });
    if (!options.volume) stacks = std::move(own);
    else std::erase_if(stacks, [&](const DicomStack& stack) { return series_of(stack) != series_of(own.front()); });
}

DicomStack choose(std::vector<DicomStack> stacks, const DicomSeriesOptions& options, const std::optional<fs::path>& file) {
    if (file) keep_own_of_file(stacks, *file, options);
    if (options.series_uid)
        keep(stacks, "series " + *options.series_uid,
             [&](const DicomStack& stack) { return series_of(stack) == *options.series_uid; });
    if (series_of(stacks.front()) != series_of(stacks.back()))
        throw Error(ErrorKind::invalid_input, "the folder holds several series; name one: " + listed(stacks));
    if (stacks.size() > 1 && !options.volume)
        throw Error(ErrorKind::invalid_input, "the series holds several volumes; name one: " + listed(stacks));
    const int volume = options.volume.value_or(1);
    if (volume < 1 || static_cast<std::size_t>(volume) > stacks.size())
        throw Error(ErrorKind::invalid_input, fmt::format("there is no volume {}; there are: {}", volume, listed(stacks)));
    return std::move(stacks[static_cast<std::size_t>(volume) - 1]);
}

/// The series that the options or the file name; nullopt: neither does.
std::optional<std::string> named_series(const FolderContent& content, const DicomSeriesOptions& options,
                                        const std::optional<fs::path>& file) {
    if (options.series_uid || !file) return options.series_uid;
    for (const DicomStack& stack : content.stacks)
        if (contains_file(stack, *file)) return series_of(stack);
    for (const DamagedImage& image : content.damaged)
        if (image.path.filename() == file->filename()) return image.series_uid;
    return std::nullopt;
}

/// Damage in other series than the named one is passed over.
void refuse_damage_of(const std::string& series, FolderContent& content) {
    for (const DamagedImage& image : content.damaged)
        if (image.series_uid == series) throw image.error;
    if (const std::size_t count = content.damaged.size(); count > 0)
        content.notes.push_back(fmt::format("left out {} damaged file{} of other series: {}{}", count, count == 1 ? "" : "s",
                                            content.damaged.front().path.filename().string(), count == 1 ? "" : ", ..."));
}

/// Where no series is named, the damaged file might be of the one that is meant.
void refuse_damage_beside(const std::string& chosen, const FolderContent& content) {
    if (content.damaged.empty()) return;
    const DamagedImage& first = content.damaged.front();
    if (first.series_uid == chosen) throw first.error;
    throw Error(first.error.kind(),
                fmt::format("{}; the other series {} can be read when it is named", first.error.what(), chosen));
}

void check_size(const Grid& grid, std::int64_t max_voxels) {
    if (grid.voxel_count() > max_voxels)
        throw Error(ErrorKind::too_large, fmt::format("the volume has {} x {} x {} voxels; the limit is {} voxels",
                                                      grid.size.i, grid.size.j, grid.size.k, max_voxels));
}

/// The chosen stack with its grid; `notes` are the folder's, then the stack's.
struct Located {
    DicomStack stack;
    StackGrid geometry;
};

Located locate(const fs::path& path, const DicomSeriesOptions& options, const Progress& progress) {
    std::error_code ignored;
    const bool is_folder = fs::is_directory(path, ignored);
    if (!is_folder && !fs::exists(path, ignored)) throw Error(ErrorKind::io, path.string() + ": no such file or folder");
    const fs::path folder = is_folder ? path : path.has_parent_path() ? path.parent_path() : fs::path(".");
    FolderContent content = read_folder(folder, progress);
    const std::optional<fs::path> file = is_folder ? std::nullopt : std::optional(path);
    const std::optional<std::string> series = named_series(content, options, file);
    if (series) refuse_damage_of(*series, content);
    if (content.stacks.empty() && !content.damaged.empty()) throw content.damaged.front().error;
    if (content.stacks.empty())
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{}: there is no DICOM image to read{}{}", path.string(), content.notes.empty() ? "" : "; ",
                                fmt::join(content.notes, "; ")));
    Located result;
    try {
        result.stack = choose(std::move(content.stacks), options, file);
        if (!series) refuse_damage_beside(series_of(result.stack), content);
        result.geometry = stack_grid(result.stack);
        check_size(result.geometry.grid, options.max_voxels);
    } catch (const Error& error) {
        if (std::string_view(error.what()).starts_with(path.string())) throw;
        throw error.with_context(path.string());
    }
    result.geometry.notes.insert(result.geometry.notes.begin(), content.notes.begin(), content.notes.end());
    return result;
}

}  // namespace

bool looks_like_dicom(const fs::path& path) {
    std::error_code failure;
    if (!fs::is_directory(path, failure)) return has_dicom_prefix(path);
    const std::vector<fs::path> files = files_in(path).files;
    return std::any_of(files.begin(), files.end(), has_dicom_prefix);
}

std::vector<DicomSeries> list_dicom_series(const fs::path& folder) {
    const FolderContent content = read_folder(folder, {});
    if (content.stacks.empty() && !content.damaged.empty()) throw content.damaged.front().error;
    std::vector<DicomSeries> result;
    for (const DicomStack& stack : content.stacks) result.push_back(describe(stack));
    return result;
}

DicomVolume read_dicom_series(const fs::path& path, const DicomSeriesOptions& options, const Progress& progress) {
    Located located = locate(path, options, progress);
    check_pixel_formats(located.stack);
    if (located.stack.slices.front().photometric_interpretation == "MONOCHROME1")
        located.geometry.notes.push_back(
            "MONOCHROME1: shown with low values bright elsewhere; the values are kept as they are");
    DicomVolume volume;
    volume.image = {located.geometry.grid, read_pixels(located.stack, progress)};
    volume.series = describe(located.stack);
    volume.notes = std::move(located.geometry.notes);
    return volume;
}

DicomGrid read_dicom_grid(const fs::path& path, const DicomSeriesOptions& options, const Progress& progress) {
    Located located = locate(path, options, progress);
    return {located.geometry.grid, describe(located.stack), std::move(located.geometry.notes)};
}

}  // namespace kontur
