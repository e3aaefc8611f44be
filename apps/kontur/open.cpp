// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include "child_process.h"
#include "commands.h"
#include "dicom_output.h"
#include "kontur/base/error.h"
#include "kontur/io/atomic_file.h"
#include "kontur/io/dicom_seg.h"
#include "viewer/image_identity.h"
#include "viewer/import_doubts.h"
#include "viewer/page.h"
#include "viewer/server.h"
#include "viewer/session.h"
#include "viewer/temporary_files.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPhantom = "phantom";
constexpr const char* kPhantomScan = "abdomen";
constexpr const char* kProjectExtension = ".kontur";

/// The command's words by what they name.
struct Words {
    fs::path image, contours, project;
};

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
        if (!fs::exists(file, ignored))
            throw Error(ErrorKind::io, fmt::format("cannot read {}: it does not exist", file.string()));
        if (has_extension(file, kProjectExtension)) put(words.project, file, "projects");
        else if (input_kind(file) == FileKind::contours) put(words.contours, file, "contours");
        else put(words.image, file, "images");
    }
    return words;
}

void check_one_project(const OpenCommand& command, const Words& words) {
    std::error_code ignored;
    if (command.project.empty() || words.project.empty() || fs::equivalent(command.project, words.project, ignored)) return;
    throw Error(ErrorKind::invalid_input, fmt::format("{} and --project {} are two projects; one at a time can be opened",
                                                      words.project.string(), command.project.string()));
}

Image phantom_image(const Progress& progress) {
    const std::vector<PhantomVolume> scans = phantom_volumes();
    const auto scan =
        std::find_if(scans.begin(), scans.end(), [](const PhantomVolume& v) { return v.name == kPhantomScan; });
    return make_phantom_image(scan->grid, {}, progress);
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

viewer::OpenedImage open_image(const ImageInput& input, Console& console) {
    viewer::OpenedImage opened;
    if (input.path == kPhantom) {
        opened.image = std::make_shared<const Image>(phantom_image(console.progress()));
        opened.title = "Phantom: upper abdomen";
        opened.reference.path = kPhantom;
    } else {
        ReadImageOptions options = input.options;
        std::vector<std::string> warnings;
        options.on_note = [&](std::string_view note) { opened.notes.emplace_back(note); };
        options.on_warning = [&](std::string_view warning) { warnings.emplace_back(warning); };
        opened.image = std::make_shared<const Image>(read_image(input.path, options, console.progress()));
        console.note(opened.notes);
        for (const std::string& warning : warnings) console.warn(warning);
        std::move(warnings.begin(), warnings.end(), std::back_inserter(opened.notes));
        opened.title = fs::absolute(input.path).lexically_normal().filename().string();
        opened.reference.path = fs::absolute(input.path).lexically_normal().string();
        tell_series(input, opened);
    }
    opened.reference.fingerprint = viewer::fingerprint(*opened.image);
    return opened;
}

/// Where the user's programs keep what he did not place himself (the XDG base directory specification).
fs::path data_folder() {
    const char* xdg = std::getenv("XDG_DATA_HOME");
    const char* home = std::getenv("HOME");
    const bool has_xdg = xdg && fs::path(xdg).is_absolute();
    if (!has_xdg && !(home && fs::path(home).is_absolute()))
        throw Error(ErrorKind::invalid_input, "there is no home folder to keep the project in; give --project");
    fs::path folder = (has_xdg ? fs::path(xdg) : fs::path(home) / ".local" / "share") / "kontur";
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
    if (!words.contours.empty()) {
        const fs::path folder = fs::absolute(words.contours).parent_path();
        if (access(folder.c_str(), W_OK) == 0) return folder / (bare_name(words.contours) + kProjectExtension);
    }
    const std::string& fingerprint = image.reference.fingerprint;
    const std::string name = bare_name(words.contours.empty() ? fs::path(image.reference.path) : words.contours);
    return data_folder() / fmt::format("{}-{}{}", name, fingerprint.substr(fingerprint.size() - 8), kProjectExtension);
}

/// What a new project starts with: the contours of the file, or a structure to draw.
ReadContours first_contours(const OpenCommand& command, const Words& words, Console& console) {
    if (words.contours.empty()) return {};
    ReadContours read = read_contours(words.contours, command.read);
    check_contours(read.contours);
    console.note(read.notes);
    if (read.contours.name.empty()) read.contours.name = bare_name(words.contours);
    return read;
}

/// Whoever names image and contours together may have named the wrong ones: said here and on the page.
void tell_doubts(const ReadContours& first, viewer::OpenedImage& image, Console& console) {
    for (const std::string& doubt : viewer::import_doubts({first.contours}, first.frame_of_reference_uid, image.image->grid,
                                                          image.frame_of_reference_uid)) {
        console.warn("do these contours belong to this image? " + doubt);
        image.notes.push_back("Do these contours belong to this image? " + doubt);
    }
}

/// A page that leads to the address, in a folder that nobody else can look into: all users of the machine can read the
/// words that a program is started with, and these would tell the token.
void write_way_in(const fs::path& file, const std::string& address) {
    std::string escaped;
    for (const char c : address)
        escaped +=
            std::string_view("<>&'\"").find(c) == std::string_view::npos ? std::string{c} : fmt::format("&#{};", int{c});
    write_file_atomically(file, fmt::format(R"(<!doctype html>
<meta charset="utf-8">
<title>kontur</title>
<meta http-equiv="refresh" content="0; url={0}">
<a href="{0}">Open kontur</a>
)",
                                            escaped));
}

void start_browser(const fs::path& page) {
    std::string program = "xdg-open", argument = page.string();
    char* words[] = {program.data(), argument.data(), nullptr};
    posix_spawn_file_actions_t silent;
    posix_spawn_file_actions_init(&silent);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    // The Ctrl+C that ends kontur must not reach the browser.
    const SpawnAttributes apart(POSIX_SPAWN_SETSID);
    const int failure = posix_spawnp(&child, program.c_str(), &silent, apart.get(), words, environ);
    posix_spawn_file_actions_destroy(&silent);
    if (failure == 0) std::thread([child] { waitpid(child, nullptr, 0); }).detach();
}

/// Best effort, and only where there is a screen: without one xdg-open starts a browser in the terminal. Returns what the
/// browser reads, and may read again, as long as kontur runs.
std::unique_ptr<viewer::TemporaryFolder> open_browser(const std::string& address, Console& console) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return nullptr;
    try {
        auto folder = std::make_unique<viewer::TemporaryFolder>();
        write_way_in(folder->path() / "open.html", address);
        start_browser(folder->path() / "open.html");
        return folder;
    } catch (const std::exception& error) {
        console.warn(fmt::format("the browser was not opened: {}", error.what()));
        return nullptr;
    }
}

}  // namespace

void run(const OpenCommand& command, Console& console) {
    const Progress progress = console.progress();
    viewer::remove_left_folders();
    const Words words = sorted(command.files);
    check_one_project(command, words);
    ImageInput input = command.image;
    input.path = words.image;
    if (input.path.empty() && !words.project.empty()) input.path = viewer::image_of_project(words.project).path;
    if (input.path.empty()) input.path = kPhantom;

    viewer::OpenedImage image = open_image(input, console);
    const fs::path project = project_path(command, words, image);
    // Read before there is a project for them: a file that cannot be read leaves none.
    std::optional<ReadContours> first;
    if (!fs::exists(project)) first = first_contours(command, words, console);
    if (first) tell_doubts(*first, image, console);
    viewer::Session session(std::move(image), project);
    if (session.is_new()) {
        session.begin_with(first ? first->contours : first_contours(command, words, console).contours);
    } else if (!words.contours.empty()) {
        console.warn(fmt::format("{} holds the work on these contours from before; they were not read again",
                                 session.project_path().string()));
    }

    if (!viewer::has_page())
        console.warn(
            "this kontur was built without its page, because Node.js or npm was missing: there is nothing to draw on");
    viewer::Server server(session, command.server);
    console.print(
        fmt::format("{}\nproject {}; every edit is saved at once, Ctrl+C ends\n", server.address(), project.string()));
    flush_stdout();  // who does not learn the address cannot use it
    const auto way_in = command.no_browser ? nullptr : open_browser(server.address(), console);
    const std::stop_callback stop(progress.stop, [&] { server.stop(); });
    server.run();
}

}  // namespace kontur::app
