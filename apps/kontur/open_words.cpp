// SPDX-License-Identifier: Apache-2.0
#include "open_words.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "drawn_images.h"
#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_drawings.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "viewer/server/workspace.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

void check_one_project(const OpenCommand& command, const Words& words) {
    std::error_code ignored;
    if (command.project.empty() || words.project.empty() || fs::equivalent(command.project, words.project, ignored)) return;
    throw Error(ErrorKind::invalid_input, fmt::format("{} and --project {} are two projects; one at a time can be opened",
                                                      words.project.string(), command.project.string()));
}

/// Beside an image it is what was drawn on that.
bool is_segmentation(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && is_dicom_seg(file);
}

Words sorted(const std::vector<fs::path>& files) {
    Words words;
    const auto put = [](fs::path& place, const fs::path& file, const char* what) {
        if (!place.empty())
            throw Error(ErrorKind::invalid_input, fmt::format("{} and {} are both {}; one at a time can be opened",
                                                              place.string(), file.string(), what));
        place = file;
    };
    for (const fs::path& file : files) {
        std::error_code ignored;
        const bool is_there = fs::exists(file, ignored);
        if (!is_there && file != viewer::kExample)
            throw Error(ErrorKind::io, fmt::format("cannot read {}: it does not exist", file.string()));
        if (!is_there) put(words.image, file, "images");
        else if (has_extension(file, kProjectExtension)) put(words.project, file, "projects");
        else if (input_kind(file) == FileKind::contours) put(words.contours, file, "contours");
        else if (!words.image.empty() && is_segmentation(file)) put(words.contours, file, "contours");
        else if (is_segmentation(words.image)) put(words.contours, std::exchange(words.image, file), "contours");
        else put(words.image, file, "images");
    }
    return words;
}

/// Of a segmentation alone the images that it was made on are opened, where they lie near it.
Words with_images_found(Words words, const DicomDrawing& drawing, const Work& work, OpenCommand& command) {
    const std::optional<ImageInput> images = images_of(drawing, work);
    if (!images && drawing.modality == "SEG") return words;
    if (!images)
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("{0} was drawn on images that do not lie near it; name them, too: kontur open FOLDER {0}, or "
                        "open them, and import it there",
                        drawing.file.string()));
    words.image = images->path;
    words.contours = drawing.file;
    choose(command.image.options, choice_of(images->options));
    return words;
}

}  // namespace

viewer::ImageChoice choice_of(const ReadImageOptions& options) {
    return {options.dicom.series_uid, options.dicom.volume, options.frame, options.prefer, options.dicom.resample_slices};
}

void choose(ReadImageOptions& options, const viewer::ImageChoice& choice) {
    options.dicom.series_uid = choice.series_uid;
    options.dicom.volume = choice.volume;
    options.frame = choice.frame;
    options.prefer = choice.prefer;
    options.dicom.resample_slices = choice.resample_slices;
}

std::string Words::title() const {
    const fs::path& named = !image.empty() ? image : !project.empty() ? project : contours;
    return fs::absolute(named).lexically_normal().filename().string();
}

Words sorted_words(const OpenCommand& command) {
    Words words = sorted(command.files);
    check_one_project(command, words);
    if (words.is_empty() && !command.project.empty()) {
        if (!fs::exists(command.project))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is no project yet; name the image that it is for", command.project.string()));
        words.project = command.project;
    }
    return words;
}

Words with_images(const Words& words, const Work& work, OpenCommand& command) {
    if (!words.project.empty() || (!words.image.empty() && !words.contours.empty())) return words;
    const fs::path& alone = words.contours.empty() ? words.image : words.contours;
    std::error_code ignored;
    if (!fs::is_regular_file(alone, ignored)) return words;
    const std::optional<DicomDrawing> drawing = dicom_drawing(alone);
    return drawing ? with_images_found(words, *drawing, work, command) : words;
}

}  // namespace kontur::app
