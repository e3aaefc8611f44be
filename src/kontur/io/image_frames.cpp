// SPDX-License-Identifier: Apache-2.0
#include "kontur/io/image_frames.h"

#include <algorithm>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/base/printable.h"
#include "kontur/io/bytes/text_header.h"
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

}  // namespace

ImageFrames read_image_frames(const fs::path& path, const ReadImageOptions& options, const Work& work) {
    if (is_nifti_name(path)) return read_nifti_frames(path);
    ReadImageOptions any = options;
    any.frame.reset();
    try {
        read_image(path, any, work);
        return {};
    } catch (const FrameChoiceError& error) {
        return {error.frames(), {}};
    }
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
