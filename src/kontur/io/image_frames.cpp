// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/images/frame_choice_error.h"
#include "kontur/io/images/frame_folder.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/nifti.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

bool is_nifti_name(const fs::path& path) {
    const std::string name = lower_case(path.filename().string());
    return name.ends_with(".nii") || name.ends_with(".nii.gz");
}

/// Steps this much of their mean apart are one and the same: trigger times are rounded, and differ from slice to slice.
constexpr double kSameStep = 0.1;

/// From one volume to the next, where every step is about the same.
std::optional<double> even_step_ms(const std::vector<DicomSeries>& volumes) {
    if (volumes.size() < 2 || !volumes.front().trigger_time_ms || !volumes.back().trigger_time_ms) return std::nullopt;
    const double mean =
        (*volumes.back().trigger_time_ms - *volumes.front().trigger_time_ms) / static_cast<double>(volumes.size() - 1);
    for (std::size_t n = 1; n < volumes.size(); ++n) {
        if (!volumes[n].trigger_time_ms || !volumes[n - 1].trigger_time_ms) return std::nullopt;
        const double step = *volumes[n].trigger_time_ms - *volumes[n - 1].trigger_time_ms;
        if (!(std::abs(step - mean) <= kSameStep * mean)) return std::nullopt;
    }
    return mean;
}

ImageFrames frames_of(const std::vector<DicomSeries>& volumes) {
    constexpr double kSecondsPerMs = 1e-3;
    ImageFrames frames{.count = static_cast<std::int64_t>(volumes.size()), .are_volumes = true};
    if (const auto step_ms = even_step_ms(volumes)) frames.step_s = kSecondsPerMs * *step_ms;
    if (const auto beat_ms = volumes.front().beat_ms; beat_ms && *beat_ms > 0) frames.cycle_s = kSecondsPerMs * *beat_ms;
    return frames;
}

/// Nobody said what lies in a folder: the ends of the order show whether it is the one that was meant.
std::string order_of(std::size_t count, const char* what, const std::string& first, const std::string& last) {
    return fmt::format("the {} are {} in this order: {} to {}", counted(count, "frame"), what, first, last);
}

ImageFrames frames_of(const DicomPhases& phases) {
    ImageFrames frames = frames_of(phases.series);
    frames.are_volumes = false;
    for (const DicomSeries& series : phases.series) frames.series_uids.push_back(series.series_uid);
    constexpr double kWhole = 100;
    if (phases.step_percent) frames.frames_per_cycle = kWhole / *phases.step_percent;
    frames.order = order_of(frames.series_uids.size(), "series", fmt::format("'{}'", phases.series.front().description),
                            fmt::format("'{}'", phases.series.back().description));
    if (!phases.others.empty()) frames.order += fmt::format("; no frames are '{}'", fmt::join(phases.others, "', '"));
    return frames;
}

ImageFrames frames_of(const std::vector<fs::path>& files) {
    ImageFrames frames{.count = static_cast<std::int64_t>(files.size()), .files = files};
    frames.order = order_of(files.size(), "files", files.front().filename().string(), files.back().filename().string());
    frames.order += "; nothing says how far apart they are in time";
    return frames;
}

/// Without a file, a volume or a lone series that was chosen.
std::optional<DicomPhases> phases_in(const fs::path& path, const DicomSeriesOptions& options, const Work& work) {
    std::error_code ignored;
    if (!fs::is_directory(path, ignored) || options.series_uid) return std::nullopt;
    DicomPhases phases = list_dicom_phases(path, options, work);
    return phases.series.size() > 1 ? std::optional(std::move(phases)) : std::nullopt;
}

ImageFrames dicom_frames(const fs::path& path, DicomSeriesOptions options, const Work& work) {
    if (!options.content) options.content = read_dicom_headers_of(path, work);
    const auto phases = phases_in(path, options, work);
    ImageFrames frames = phases ? frames_of(*phases) : frames_of(list_dicom_volumes(path, options, work));
    frames.headers = options.content;
    return frames;
}

}  // namespace

ImageFrames frames_beside(const fs::path& folder, const DicomSeriesOptions& options, const Work& work) {
    DicomSeriesOptions known = options;
    if (!known.content) known.content = read_dicom_headers_of(folder, work);
    const DicomPhases phases = list_dicom_phases(folder, known, work);
    ImageFrames frames = phases.series.size() > 1 ? frames_of(phases) : ImageFrames{};
    frames.headers = known.content;
    return frames;
}

std::vector<fs::path> checked_frame_files(const fs::path& folder, const ReadImageOptions& options) {
    std::vector<fs::path> files = frame_files(folder);
    if (files.empty()) return files;
    ReadImageOptions silent = options;
    silent.frame.reset();
    silent.on_note = silent.on_warning = {};
    grid_of_frames(files, [&](const fs::path& file) {
        if (const std::int64_t frames = read_image_frames(file, silent).count; frames > 1)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} has {} frames itself, and of a folder each file is one frame; name the file alone",
                                    file.string(), frames));
        return read_grid(file, silent);
    });
    return files;
}

ImageFrames read_image_frames(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    if (is_nifti_name(path)) return read_nifti_frames(path);
    if (looks_like_dicom(path) && !is_dicom_seg(path)) return dicom_frames(path, options.dicom, work);
    if (const std::vector<fs::path> files = checked_frame_files(path, options); !files.empty()) return frames_of(files);
    ReadImageOptions any = options;
    any.frame.reset();
    any.max_voxels = 1;  // no voxel is read: either a frame is missing, or there are too many voxels
    try {
        read_image(path, any, work);
    } catch (const FrameChoiceError& error) {
        return {.count = error.frames()};
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::too_large) throw;
    }
    return {};
}

ImageSource source_of_frame(const ImageSource& image, const ImageFrames& frames, std::int64_t frame) {
    if (frame < 1 || frame > frames.count)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} has no frame {}; it has {}", image.path.string(), frame,
                                frames.count > 1 ? fmt::format("1 to {}", frames.count) : "1 alone"));
    ImageSource source = image;
    const auto place = static_cast<std::size_t>(frame) - 1;
    source.options.dicom.content = frames.headers;
    source.options.frame.reset();
    if (!frames.series_uids.empty()) source.options.dicom.series_uid = frames.series_uids.at(place);
    else if (frames.are_volumes) source.options.dicom.volume = static_cast<int>(frame);
    else if (!frames.files.empty()) source.path = frames.files.at(place);
    else source.options.frame = frame;
    return source;
}

void check_frames_name(const fs::path& path) {
    if (!is_nifti_name(path))
        throw Error(ErrorKind::unsupported,
                    "masks of several frames are written as .nii or .nii.gz, not as " + path.filename().string());
}

void write_masks(const fs::path& path, std::span<const Mask> masks, std::optional<double> step_s, std::int64_t label_value,
                 const Provenance& provenance) {
    check_frames_name(path);
    check_label_value(label_value);
    if (masks.empty()) throw Error(ErrorKind::invalid_input, "there is no mask to write; at least 1 is needed");
    for (std::size_t n = 0; n < masks.size(); ++n) {
        check_mask(masks[n], "the mask of frame " + std::to_string(n + 1));
        if (masks[n].grid != masks.front().grid)
            throw Error(ErrorKind::invalid_input,
                        "the mask of frame " + std::to_string(n + 1) + " has another grid than that of frame 1");
    }
    const auto write = [&]<typename Value>(Value inside) {
        std::vector<Value> all;
        all.reserve(masks.size() * masks.front().values.size());
        for (const Mask& mask : masks)
            for (const std::uint8_t v : mask.values) all.push_back(v ? inside : Value{0});
        ImageView view(masks.front().grid, std::span<const Value>(all));
        view.provenance = provenance;
        write_nifti(path, view, {static_cast<std::int64_t>(masks.size()), step_s});
    };
    if (label_value <= 255) write(static_cast<std::uint8_t>(label_value));
    else write(static_cast<std::uint16_t>(label_value));
}

void write_label_maps(const fs::path& path, std::span<const Image> frames, std::optional<double> step_s,
                      std::vector<LabelName> names, const Provenance& provenance) {
    check_frames_name(path);
    if (frames.empty()) throw Error(ErrorKind::invalid_input, "there is no label map to write; at least 1 is needed");
    std::set<std::int64_t> values;
    for (std::size_t n = 0; n < frames.size(); ++n) {
        check_image(frames[n], "the label map of frame " + std::to_string(n + 1));
        if (frames[n].grid != frames.front().grid || frames[n].samples.index() != frames.front().samples.index())
            throw Error(ErrorKind::invalid_input, "the label map of frame " + std::to_string(n + 1) +
                                                      " has another grid or type than that of frame 1");
        for (const auto& [value, count] : count_labels(frames[n])) values.insert(value);
    }
    std::erase_if(names, [&](const LabelName& name) { return !values.contains(name.label); });
    std::visit(
        [&]<typename Value>(const std::vector<Value>&) {
            std::vector<Value> all;
            for (const Image& frame : frames) {
                const auto& its = std::get<std::vector<Value>>(frame.samples);
                all.insert(all.end(), its.begin(), its.end());
            }
            ImageView view(frames.front().grid, std::span<const Value>(all));
            view.provenance = provenance;
            view.labels = std::move(names);
            write_nifti(path, view, {static_cast<std::int64_t>(frames.size()), step_s});
        },
        frames.front().samples);
}

}  // namespace kontur
