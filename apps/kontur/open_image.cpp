// SPDX-License-Identifier: Apache-2.0
#include "open_image.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "dicom_output.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "kontur/io/dicom/dicom_suv.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"
#include "kontur/phantom/phantom.h"
#include "kontur/phantom/volumes.h"
#include "open_words.h"
#include "viewer/images/image_identity.h"
#include "viewer/server/workspace.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPhantomScan = "abdomen";

Image phantom_image(const Work& work) {
    const std::vector<PhantomVolume> scans = phantom_volumes();
    const auto scan =
        std::find_if(scans.begin(), scans.end(), [](const PhantomVolume& v) { return v.name == kPhantomScan; });
    return make_phantom_image(scan->grid, {}, work);
}

/// A DICOM folder is looked through once, however often it is asked.
ImageInput with_headers(ImageInput input, const Work& work) {
    if (looks_like_dicom(input.path) && !is_dicom_seg(input.path))
        input.options.dicom.content = read_dicom_headers_of(input.path, work);
    return input;
}

/// Whose image it is, and what files that are made of it refer to.
void tell_series(const ImageInput& input, viewer::OpenedImage& opened) {
    opened.frame_of_reference_uid = frame_of_reference_of(input);
    if (!looks_like_dicom(input.path) || is_dicom_seg(input.path)) return;
    opened.series = read_dicom_grid(input.path, input.options.dicom).series;
    opened.identity = dicom_identity(opened.series->files.front());
    const auto& [patient, description] = std::pair(opened.identity.patient_name, opened.identity.series_description);
    if (!description.empty()) opened.title = description;
    if (!patient.empty()) opened.title = patient + ", " + opened.title;
}

bool is_example(const fs::path& path) {
    std::error_code ignored;
    return path == viewer::kExample && !fs::exists(path, ignored);
}

void open_file(const ImageInput& input, const Work& work, viewer::OpenedImage& opened, Messages& messages) {
    ReadImageOptions options = input.options;
    std::vector<std::string> warnings;
    options.on_note = [&](std::string_view note) { opened.notes.emplace_back(note); };
    options.on_warning = [&](std::string_view warning) { warnings.emplace_back(warning); };
    opened.image = std::make_shared<const Image>(read_image(input.path, options, work));
    messages.notes.insert(messages.notes.end(), opened.notes.begin(), opened.notes.end());
    messages.warnings.insert(messages.warnings.end(), warnings.begin(), warnings.end());
    opened.notes.insert(opened.notes.end(), warnings.begin(), warnings.end());
    opened.title = fs::absolute(input.path).lexically_normal().filename().string();
    opened.reference.path = fs::absolute(input.path).lexically_normal().string();
    opened.reference.choice = choice_of(input.options);
    tell_series(input, opened);
}

Image times(const Image& image, double factor) {
    std::vector<float> values;
    std::visit(
        [&](const auto& samples) {
            values.reserve(samples.size());
            for (const auto sample : samples) values.push_back(static_cast<float>(factor * static_cast<double>(sample)));
        },
        image.samples);
    return {image.grid, std::move(values)};
}

/// PET in Bq/ml is shown as SUV, where its files tell how.
void turn_into_suv(viewer::OpenedImage& opened, Messages& messages) {
    const auto scale = opened.series ? suv_scale(opened.series->files.front()) : std::nullopt;
    if (!scale) return;
    opened.notes.push_back(scale->sentence);
    messages.notes.push_back(scale->sentence);
    if (scale->suv_per_bqml == 0) return;
    opened.image = std::make_shared<const Image>(times(*opened.image, scale->suv_per_bqml));
    opened.identity.unit = kSuvUnit;
}

/// Of the image of which one frame or volume was opened.
ImageFrames frames_of(const ImageInput& input) {
    if (!input.options.frame && !input.options.dicom.volume && !input.options.dicom.series_uid) return {};
    try {
        ImageFrames frames = read_image_frames(input.path, input.options);
        if (frames.count > 1 || !input.options.dicom.series_uid || !fs::is_directory(input.path)) return frames;
        return frames_beside(input.path, input.options.dicom);
    } catch (const Error&) {
        return {};  // what was opened is all that there is
    }
}

/// From 1.
std::int64_t place_of(const std::string& uid, const std::vector<std::string>& uids) {
    return std::find(uids.begin(), uids.end(), uid) - uids.begin() + 1;
}

/// The other volumes are read when somebody looks at them.
viewer::Times times_of(const ImageInput& input, viewer::OpenedImage& opened) {
    const ImageFrames frames = frames_of(input);
    const auto own = !frames.series_uids.empty() ? place_of(*input.options.dicom.series_uid, frames.series_uids)
                     : frames.are_volumes        ? *input.options.dicom.volume
                                                 : input.options.frame.value_or(1);
    const auto read = [input, frames](int time) {
        Messages messages;  // what there is to say was said of the one that was opened
        viewer::OpenedImage image;
        open_file(source_of_frame(input, frames, time + 1), {}, image, messages);
        turn_into_suv(image, messages);
        return image.image;
    };
    if (!frames.order.empty()) opened.notes.push_back(frames.order);
    return {static_cast<int>(frames.count), static_cast<int>(own) - 1, read, frames.step_s, frames.cycle_frames()};
}

}  // namespace

viewer::OpenedImage open_image(const ImageInput& input, const Work& work, Messages& messages) {
    viewer::OpenedImage opened;
    if (is_example(input.path)) {
        opened.image = std::make_shared<const Image>(phantom_image(work));
        opened.title = "Phantom: upper abdomen";
        opened.reference.path = viewer::kExample;
    } else {
        const ImageInput known = with_headers(input, work);
        open_file(known, work, opened, messages);
        opened.times = times_of(known, opened);
    }
    work.report("look at values", 1);
    opened.reference.fingerprint = viewer::fingerprint(*opened.image);
    turn_into_suv(opened, messages);  // by its file's values it is known again
    return opened;
}

}  // namespace kontur::app
