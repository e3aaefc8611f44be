// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/dicom/dicom_series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>

#include "kontur/base/checks.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_content.h"
#include "kontur/io/dicom/dicom_doubts.h"
#include "kontur/io/dicom/dicom_folder.h"
#include "kontur/io/dicom/dicom_grid.h"
#include "kontur/io/dicom/dicom_header.h"
#include "kontur/io/dicom/dicom_pixels.h"
#include "kontur/io/dicom/dicom_stack.h"
#include "kontur/io/dicom/dicom_start.h"
#include "kontur/io/dicom/uneven_slices_error.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kVolumesListed = 20;

std::string listed(const std::vector<DicomStack>& stacks) {
    std::string text;
    std::map<std::string, int> volume_of_series;
    for (std::size_t n = 0; n < stacks.size(); ++n) {
        const DicomSeries series = described(stacks[n]);
        const int volume = ++volume_of_series[series.series_uid];
        if (n == kVolumesListed) text += fmt::format("; and {} more", stacks.size() - n);
        if (n >= kVolumesListed) continue;
        text += fmt::format("{}{} volume {} ({}{}, {} of {} x {}{})", n == 0 ? "" : "; ", series.series_uid, volume,
                            series.modality, series.description.empty() ? "" : " '" + series.description + "'",
                            counted(series.files.size(), "slice"), series.columns, series.rows,
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

/// All volumes of one series, or the one that the file stands for.
std::vector<DicomStack> of_one_series(std::vector<DicomStack> stacks, const DicomSeriesOptions& options,
                                      const std::optional<fs::path>& file) {
    if (file) keep_own_of_file(stacks, *file, options);
    if (options.series_uid)
        keep(stacks, "series " + *options.series_uid,
             [&](const DicomStack& stack) { return series_of(stack) == *options.series_uid; });
    if (series_of(stacks.front()) != series_of(stacks.back()))
        throw Error(ErrorKind::invalid_input,
                    "the folder holds several series; choose one with the option series_uid: " + listed(stacks));
    return stacks;
}

DicomStack choose(std::vector<DicomStack> stacks, const DicomSeriesOptions& options) {
    if (stacks.size() > 1 && !options.volume)
        throw Error(ErrorKind::invalid_input,
                    "the series holds several volumes; choose one with the option volume: " + listed(stacks));
    const int volume = options.volume.value_or(1);
    if (volume < 1 || static_cast<std::size_t>(volume) > stacks.size())
        throw Error(ErrorKind::invalid_input, fmt::format("there is no volume {}; there are: {}", volume, listed(stacks)));
    return std::move(stacks[static_cast<std::size_t>(volume) - 1]);
}

/// The series that the options or the file name; nullopt: neither does.
std::optional<std::string> named_series(const DicomContent& content, const DicomSeriesOptions& options,
                                        const std::optional<fs::path>& file) {
    if (options.series_uid || !file) return options.series_uid;
    for (const DicomStack& stack : content.stacks)
        if (contains_file(stack, *file)) return series_of(stack);
    return std::nullopt;
}

/// A named file that makes no volume says why.
void refuse_file(const DicomContent& content, const fs::path& file) {
    for (const DamagedImage& image : content.damaged)
        if (image.path.filename() == file.filename()) throw image.error;
    for (const auto& [path, why] : content.others)
        if (path.filename() == file.filename())
            throw Error(ErrorKind::invalid_input, fmt::format("{} makes no volume: {}{}{}", file.string(), why.reason,
                                                              why.detail.empty() ? "" : "; ", why.detail));
}

void refuse_damage_of(const std::string& series, const DicomContent& content) {
    for (const DamagedImage& image : content.damaged)
        if (image.series_uid == series) throw image.error;
}

bool is_dose(const DicomStack& stack) { return !stack.slices.front().dose_unit.empty(); }

/// A dose beside the images that it belongs to is not meant unless it is named.
void set_doses_aside(DicomContent& content) {
    if (std::all_of(content.stacks.begin(), content.stacks.end(), is_dose) && content.damaged.empty()) return;
    std::set<fs::path> files;
    for (const DicomStack& stack : content.stacks)
        if (is_dose(stack))
            for (const DicomHeader& slice : stack.slices) files.insert(slice.path);
    std::erase_if(content.stacks, is_dose);
    for (const fs::path& file : files) content.others.push_back({file, {"RTDOSE"}});
}

/// Of different people, whatever else they have in common.
void refuse_two_patients(const std::string& series, const std::vector<DicomStack>& stacks) {
    const DicomHeader* first = nullptr;
    for (const DicomStack& stack : stacks)
        for (const DicomHeader& slice : stack.slices) {
            if (slice.series_uid != series || slice.patient_id.empty()) continue;
            if (!first) first = &slice;
            if (slice.patient_id != first->patient_id)
                throw Error(ErrorKind::invalid_input,
                            fmt::format("the series {} has images of two patients: {} names '{}', {} names '{}'; give each "
                                        "patient a folder",
                                        series, name_of(*first), first->patient_id, name_of(slice), slice.patient_id));
        }
}

[[noreturn]] void refuse_empty(const fs::path& path, const DicomContent& content) {
    if (!content.damaged.empty()) throw content.damaged.front().error;
    std::vector<std::string> notes = content.notes;
    for (std::string& note : dicom_doubts(content, {}, true).notes) notes.push_back(std::move(note));
    throw Error(ErrorKind::invalid_input, fmt::format("{}: there is no DICOM image to read{}{}", path.string(),
                                                      notes.empty() ? "" : "; ", fmt::join(notes, "; ")));
}

void check_size(const Grid& grid, std::int64_t max_voxels) {
    if (grid.voxel_count() > max_voxels)
        throw Error(ErrorKind::too_large, fmt::format("the volume has {} x {} x {} voxels; the limit is {} voxels",
                                                      grid.size.i, grid.size.j, grid.size.k, max_voxels));
}

/// The chosen stack with its grid and all that is to be told.
struct ChosenStack {
    DicomStack stack;
    Grid grid;
    std::vector<SliceBetween> resampled;
    std::vector<std::string> notes, warnings;
};

/// The folder or, of a file, the one that it lies in.
DicomContent read_content(const fs::path& path, const std::optional<fs::path>& file, const Work& work) {
    const fs::path folder = !file ? path : path.has_parent_path() ? path.parent_path() : fs::path(".");
    return read_dicom_content(folder, file ? dicom_files_in(folder) : dicom_folder(folder), file, work);
}

void append(std::vector<std::string>& all, std::vector<std::string> more) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
}

ChosenStack locate_in(DicomContent content, const DicomSeriesOptions& options, const std::optional<fs::path>& file) {
    const std::optional<std::string> series = named_series(content, options, file);
    if (series) refuse_damage_of(*series, content);
    ChosenStack result;
    result.stack = choose(of_one_series(content.stacks, options, file), options);
    const std::string chosen = series_of(result.stack);
    refuse_damage_of(chosen, content);
    refuse_two_patients(chosen, content.stacks);
    StackGrid geometry = stack_grid(result.stack, options.resample_slices);
    result.grid = geometry.grid;
    result.resampled = std::move(geometry.resampled);
    check_size(result.grid, options.max_voxels);
    DicomDoubts doubts = dicom_doubts(content, result.stack, series.has_value());
    result.notes = std::move(content.notes);
    append(result.notes, std::move(doubts.notes));
    append(result.notes, std::move(geometry.notes));
    if (is_dose(result.stack))
        result.notes.push_back(fmt::format("a dose; its unit is {}", result.stack.slices.front().dose_unit));
    result.warnings = std::move(doubts.warnings);
    return result;
}

/// `find` on what is in the folder; its errors name the path.
template <class Find>
auto find_in(const fs::path& path, const DicomSeriesOptions& options, const Work& work, const Find& find) {
    check_at_least("the limit of voxels", options.max_voxels, 1);
    std::error_code ignored;
    const bool is_folder = fs::is_directory(path, ignored);
    if (!is_folder && !fs::exists(path, ignored)) throw Error(ErrorKind::io, path.string() + ": no such file or folder");
    const std::optional<fs::path> file = is_folder ? std::nullopt : std::optional(path);
    DicomContent content = options.content ? *options.content : read_content(path, file, work);
    if (file) refuse_file(content, *file);
    else if (!options.series_uid) set_doses_aside(content);
    if (content.stacks.empty()) refuse_empty(path, content);
    try {
        return find(std::move(content), file);
    } catch (const UnevenSlicesError& error) {
        throw UnevenSlicesError(error.with_context(path.string()).what());
    } catch (const Error& error) {
        if (std::string_view(error.what()).starts_with(path.string())) throw;
        throw error.with_context(path.string());
    }
}

ChosenStack locate(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    return find_in(path, options, work, [&](DicomContent content, const std::optional<fs::path>& file) {
        return locate_in(std::move(content), options, file);
    });
}

/// The samples at places between slices of `size` samples.
Image::Samples at_slices(const Image::Samples& all, const std::vector<SliceBetween>& places, std::size_t size) {
    return std::visit(
        [&]<class Sample>(const std::vector<Sample>& samples) -> Image::Samples {
            std::vector<Sample> between;
            between.reserve(places.size() * size);
            for (const auto& [slice, to_next] : places) {
                const Sample* const here = samples.data() + slice * size;
                const Sample* const next = to_next > 0 ? here + size : here;
                for (std::size_t n = 0; n < size; ++n) {
                    const double value = std::lerp(static_cast<double>(here[n]), static_cast<double>(next[n]), to_next);
                    between.push_back(static_cast<Sample>(std::is_integral_v<Sample> ? std::round(value) : value));
                }
            }
            return between;
        },
        all);
}

}  // namespace

bool looks_like_dicom(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_regular_file(path, ignored)) return has_dicom_prefix(path);
    if (!fs::is_directory(path, ignored)) return false;
    const auto holds_dicom = [](const DicomFolder& folder) {
        return std::any_of(folder.files.begin(), folder.files.end(), has_dicom_prefix);
    };
    return holds_dicom(dicom_files_in(path)) || holds_dicom(dicom_folder(path));
}

std::shared_ptr<const DicomContent> read_dicom_headers_of(const fs::path& path, const Work& work) {
    std::error_code ignored;
    const std::optional<fs::path> file = fs::is_directory(path, ignored) ? std::nullopt : std::optional(path);
    return std::make_shared<const DicomContent>(read_content(path, file, work));
}

std::vector<DicomSeries> list_dicom_series(const fs::path& folder, const Work& work) {
    const DicomContent content = read_content(folder, std::nullopt, work);
    if (content.stacks.empty() && !content.damaged.empty()) throw content.damaged.front().error;
    std::vector<DicomSeries> result;
    for (const DicomStack& stack : content.stacks) result.push_back(described(stack));
    return result;
}

std::vector<DicomSeries> list_dicom_volumes(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    DicomSeriesOptions any_volume = options;
    any_volume.volume = 1;
    return find_in(path, options, work, [&](const DicomContent& content, const std::optional<fs::path>& file) {
        std::vector<DicomSeries> volumes;
        for (const DicomStack& stack : of_one_series(content.stacks, any_volume, file)) volumes.push_back(described(stack));
        return volumes;
    });
}

Image read_dicom_slice(const fs::path& file, std::int64_t frame) {
    auto content = read_dicom_headers(file);
    if (auto* damaged = std::get_if<DamagedImage>(&content)) throw damaged->error;
    auto* slices = std::get_if<std::vector<DicomHeader>>(&content);
    if (!slices) throw Error(ErrorKind::invalid_input, file.string() + " holds no DICOM image");
    const auto count = static_cast<std::int64_t>(slices->size());
    if (frame < 1 || frame > count)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} has no frame {}; it has 1 to {}", file.string(), frame, count));
    DicomStack stack;
    stack.slices.push_back(std::move((*slices)[static_cast<std::size_t>(frame) - 1]));
    if (!(stack.slices.front().thickness_mm > 0.0)) stack.slices.front().thickness_mm = 1;
    check_pixel_formats(stack);
    const Grid grid = stack_grid(stack).grid;
    return {grid, read_pixels(stack, {})};
}

DicomVolume read_dicom_series(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    ChosenStack located = locate(path, options, work);
    check_pixel_formats(located.stack);
    if (located.stack.slices.front().photometric_interpretation == "MONOCHROME1")
        located.notes.push_back("MONOCHROME1: shown with low values bright elsewhere; the values are kept as they are");
    DicomVolume volume;
    volume.image = {located.grid, read_pixels(located.stack, work)};
    if (!located.resampled.empty())
        volume.image.samples = at_slices(volume.image.samples, located.resampled,
                                         static_cast<std::size_t>(located.grid.size.i * located.grid.size.j));
    volume.series = described(located.stack);
    volume.notes = std::move(located.notes);
    volume.warnings = std::move(located.warnings);
    return volume;
}

DicomGrid read_dicom_grid(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    ChosenStack located = locate(path, options, work);
    return {located.grid, described(located.stack), std::move(located.notes), std::move(located.warnings)};
}

}  // namespace kontur
