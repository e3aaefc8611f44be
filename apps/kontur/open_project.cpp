// SPDX-License-Identifier: Apache-2.0
#include "open_project.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "drawn_images.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/folders.h"
#include "kontur/io/dicom/dicom_drawings.h"
#include "kontur/io/image.h"
#include "kontur/shape/repeated_contours.h"
#include "viewer/files/import_doubts.h"
#include "viewer/files/imports.h"
#include "viewer/images/further_image.h"
#include "viewer/images/same_space.h"
#include "viewer/model/temporary_files.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

ImageInput input_of(const fs::path& path, const viewer::ImageChoice& choice) {
    ImageInput input{path, {}};
    choose(input.options, choice);
    return input;
}

fs::path data_folder() {
    const std::optional<fs::path> data = user_folder("XDG_DATA_HOME", ".local/share");
    if (!data) throw Error(ErrorKind::invalid_input, "there is no home folder to keep the project in; give --project");
    fs::path folder = *data / "kontur";
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw Error(ErrorKind::io, fmt::format("cannot make {}: {}; give --project", folder.string(), error.message()));
    return folder;
}

std::string bare_name(const fs::path& path) {
    const std::string name = path.filename().string();
    for (const char* extension : {".mrk.json", ".nii.gz", ".seg.nrrd"})
        if (has_extension(path, extension)) return name.substr(0, name.size() - std::string_view(extension).size());
    return path.stem().string();
}

fs::path project_path(const OpenCommand& command, const Words& words, const viewer::OpenedImage& image) {
    if (!command.project.empty()) return command.project;
    if (!words.project.empty()) return words.project;
    if (!words.contours.empty() && !looks_like_dicom(words.contours)) {  // nothing of ours is left among a hospital's files
        const fs::path folder = fs::absolute(words.contours).parent_path();
        if (access(folder.c_str(), W_OK) == 0) return folder / (bare_name(words.contours) + kProjectExtension);
    }
    const std::string& fingerprint = image.reference.fingerprint;
    const std::string name = bare_name(words.contours.empty() ? fs::path(image.reference.path) : words.contours);
    return data_folder() / fmt::format("{}-{}{}", name, fingerprint.substr(fingerprint.size() - 8), kProjectExtension);
}

/// A structure set with all its regions, or each segment traced, read by a process of its own.
viewer::ImportContent drawn_by_others(const fs::path& file, const Work& work) {
    const viewer::Upload upload{.extension = ".dcm", .file = file.filename().string()};
    return viewer::import_apart(viewer::read_bytes(file), upload, work);
}

/// What a new project starts with: the contours of the file, or a structure to draw.
viewer::ImportContent first_contours(const OpenCommand& command, const Words& words, const Work& work,
                                     ProjectSession& result) {
    if (command.read.curves && words.contours.empty())
        throw Error(ErrorKind::invalid_input, "--curves is for 3D Slicer's markups (.mrk.json), and there are none");
    if (words.contours.empty()) return {{ContourSet{}}, {}, {}, {}};
    viewer::ImportContent first;
    if (!command.read.roi && !command.read.curves && dicom_drawing(words.contours)) {
        first = drawn_by_others(words.contours, work);
    } else {
        ReadContours read = read_contours(words.contours, command.read);
        try {
            for (std::string& note : check_and_tidy_moments(read.contours)) read.notes.push_back(std::move(note));
        } catch (const Error& error) {
            throw error.with_context(words.contours.string());
        }
        first = {{std::move(read.contours)}, std::move(read.notes), std::move(read.frame_of_reference_uid), {}};
    }
    result.messages.notes.insert(result.messages.notes.end(), first.notes.begin(), first.notes.end());
    for (ContourSet& set : first.sets)
        if (set.name.empty()) set.name = bare_name(words.contours);
    return first;
}

/// Whoever names image and contours together may have named the wrong ones: said here and on the page.
void tell_doubts(const viewer::ImportContent& first, const std::string& file, viewer::OpenedImage& image,
                 ProjectSession& result) {
    for (const std::string& doubt :
         viewer::import_doubts(first.sets, {first.frame_of_reference_uid, first.patient}, image.image->grid,
                               {image.frame_of_reference_uid, viewer::patient_words(image.identity)})) {
        result.messages.warnings.push_back(fmt::format("does {} belong to this image? {}", file, doubt));
        image.notes.push_back(fmt::format("Does {} belong to this image? {}", file, doubt));
    }
}

/// A folder that was renamed is no reason to lose what was drawn.
void check_is_there(const fs::path& image, const fs::path& project) {
    std::error_code unreachable;
    if (image == viewer::kExample || fs::exists(image, unreachable)) return;
    throw viewer::ImageNotFound(
        fmt::format("{} was drawn on {}, which is not there; where it has moved, name its new place, "
                    "too: kontur open {} IMAGE",
                    project.string(), image.string(), project.filename().string()),
        image.string());
}

/// The image that the words name, or the project does, with the choice that it was drawn on.
ImageInput image_input(const OpenCommand& command, const Words& words) {
    ImageInput input = command.image;
    input.path = words.image;
    if (input.path.empty() && !words.project.empty()) {
        const viewer::ImageReference drawn_on = viewer::image_of_project(words.project);
        input.path = drawn_on.path;
        check_is_there(input.path, words.project);
        if (choice_of(input.options) == viewer::ImageChoice{}) choose(input.options, drawn_on.choice);
    }
    if (input.path.empty()) input.path = viewer::kExample;
    return input;
}

/// The one that the command names, if it does and it fits: read before there is a project.
std::optional<viewer::OpenedImage> named_second_image(const ImageInput& input, const viewer::OpenedImage& first,
                                                      const Work& work, ProjectSession& result) {
    if (input.path.empty()) return std::nullopt;
    try {
        viewer::OpenedImage second = open_image(input, work, result.messages);
        for (const std::string& sentence : viewer::assumptions_of_one_space(first, second))
            result.messages.warnings.push_back(sentence);
        return second;
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        throw SecondImageError(error);
    }
}

/// The one that the project keeps. What is wrong with it keeps nobody from work on the first.
void show_kept_second_image(viewer::Session& session, const Work& work, ProjectSession& result) {
    const std::optional<viewer::ImageReference> kept = session.kept_second_image();
    if (!kept) return;
    try {
        viewer::OpenedImage second = open_image(input_of(kept->path, kept->choice), work, result.messages);
        if (second.reference.fingerprint != kept->fingerprint)
            session.add_note(
                fmt::format("The second image, {}, has changed since it was added to this project.", second.title));
        session.put_second_image(std::move(second));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        result.messages.warnings.push_back(fmt::format("the second image is not shown: {}", error.what()));
        session.add_note(fmt::format("The second image is not shown: {}", error.what()));
    }
}

}  // namespace

ProjectSession open_project(const OpenCommand& given, const Words& named, const Work& work) {
    ProjectSession result;
    OpenCommand command = given;
    const Words words = with_images(named, work, command);
    viewer::OpenedImage image = open_image(image_input(command, words), work, result.messages);
    const fs::path project = project_path(command, words, image);
    // Read before there is a project for them: a file that cannot be read leaves none.
    std::optional<viewer::ImportContent> first;
    if (!fs::exists(project)) first = first_contours(command, words, work, result);
    if (first) tell_doubts(*first, words.contours.filename().string(), image, result);
    auto second = named_second_image(command.second_image, image, work, result);
    work.check();
    result.session = std::make_shared<viewer::Session>(std::move(image), project);
    if (result.session->is_new()) {
        result.session->begin_with(first ? first->sets : first_contours(command, words, work, result).sets);
    } else if (!words.contours.empty()) {
        result.messages.warnings.push_back(
            fmt::format("{} holds the work on these contours from before; they were not read again",
                        result.session->project_path().string()));
    }
    if (second) result.session->put_second_image(std::move(*second));
    else show_kept_second_image(*result.session, work, result);
    return result;
}

std::shared_ptr<viewer::Session> open_project(const viewer::OpenRequest& request, const Work& work) {
    OpenCommand command;
    command.files = {request.path};
    if (!request.image.empty()) command.files.push_back(request.image);
    choose(command.image.options, request.choice);
    return open_project(command, sorted_words(command), work).session;
}

viewer::OpenedImage read_second_image(const viewer::OpenRequest& request, const Work& work) {
    Messages messages;  // what there is to say is in the image's own notes
    return open_image(input_of(request.path, request.choice), work, messages);
}

fs::path viewer_file(std::string_view name) {
    try {
        return data_folder() / name;
    } catch (const Error&) {
        return {};
    }
}

}  // namespace kontur::app
