// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image_frames.h"

#include <cmath>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/text_header.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/images/frame_choice_error.h"
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

}  // namespace

ImageFrames read_image_frames(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    if (is_nifti_name(path)) return read_nifti_frames(path);
    if (looks_like_dicom(path) && !is_dicom_seg(path)) return frames_of(list_dicom_volumes(path, options.dicom, work));
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

ReadImageOptions of_frame(ReadImageOptions options, const ImageFrames& frames, std::int64_t frame) {
    if (frames.are_volumes) options.dicom.volume = static_cast<int>(frame);
    else options.frame = frame;
    return options;
}

void check_frames_name(const fs::path& path) {
    if (!is_nifti_name(path))
        throw Error(ErrorKind::unsupported,
                    "masks of several frames are written as .nii or .nii.gz, not as " + path.filename().string());
}

void write_masks(const fs::path& path, std::span<const Mask> masks, std::optional<double> step_s,
                 const WriteMaskOptions& options) {
    check_frames_name(path);
    check_label_value(options.label_value);
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
        view.provenance = options.provenance;
        write_nifti(path, view, {static_cast<std::int64_t>(masks.size()), step_s});
    };
    if (options.label_value <= 255) write(static_cast<std::uint8_t>(options.label_value));
    else write(static_cast<std::uint16_t>(options.label_value));
}

}  // namespace kontur
