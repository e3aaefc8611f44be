// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fcntl.h>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "child_process.h"
#include "commands.h"
#include "kontur/base/error.h"
#include "kontur/base/stop.h"
#include "kontur/io/bytes/atomic_file.h"
#include "open_project.h"
#include "viewer/model/temporary_files.h"
#include "viewer/server/page.h"
#include "viewer/server/server.h"
#include "viewer/server/workspace.h"

namespace kontur::app {
namespace {

namespace fs = std::filesystem;

/// Whoever waits longer than this for an image gets the address first, and sees there how far it is.
constexpr std::chrono::milliseconds kSilence(700);

/// For what is being read to be given up.
constexpr std::chrono::seconds kPatience(60);

constexpr const char* kChooseInPage = "choose an image or a project in the page; Ctrl+C ends\n";

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

/// Throws what the archive's address and credentials have wrong.
std::optional<viewer::NamedArchive> named_archive(const OpenCommand& command) {
    if (command.archive_address.empty()) return std::nullopt;
    const archive::Address address = archive::parse_address(command.archive_address);
    viewer::NamedArchive named{{address.service, "", "", ""}, access_of(*command.archive_options)};
    const archive::Http checked(named.service, named.access);
    return named;
}

viewer::Workspace::Services services(const OpenCommand& command, const Words& words) {
    std::vector<viewer::Place> places = viewer::usual_places();
    std::error_code ignored;
    if (fs::is_directory(words.image, ignored)) places.insert(places.begin(), {words.title(), fs::absolute(words.image)});
    return {[](const viewer::OpenRequest& request, const Work& work) { return open_project(request, work); },
            [](const viewer::OpenRequest& request, const Work& work) { return read_second_image(request, work); },
            viewer::Places(places),
            viewer_file("recent.json"),
            viewer_file("arrangements.json"),
            viewer_file("outbox"),
            named_archive(command)};
}

/// The command's own image, read in the background of the workspace, which must not outlive it.
class FirstImage {
public:
    FirstImage(const OpenCommand& command, Words words, Console& console)
        : command_(command), words_(std::move(words)), console_(console) {}

    void begin(viewer::Workspace& workspace) {
        workspace_ = &workspace;
        workspace.begin(
            words_.title(), [this](const Work& pages) { return read(pages); },
            [this](const std::exception_ptr& failure) { end(failure); });
    }

    void wait_for(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, time, [&] { return has_ended_ || !workspace_; });
    }

    /// Throws why it could not be opened.
    void check() const {
        const std::scoped_lock lock(mutex_);
        if (failure_) std::rethrow_exception(failure_);
    }

    /// From now on the project's place is told when it is known, and the server ends when there will be none. nullptr: no
    /// longer.
    void serve(viewer::Server* server) {
        const std::scoped_lock lock(mutex_);
        server_ = server;
        if (has_ended_) tell_end();
    }

private:
    std::shared_ptr<viewer::Session> read(const Work& pages) {
        const Work terminal = console_.work();
        const StopCallback stop(terminal.stop, [this] { workspace_->cancel(); });
        const auto tell = [&](std::string_view stage, double fraction) {
            if (terminal.callback) terminal.callback(stage, fraction);
            if (pages.callback) pages.callback(stage, fraction);
        };
        ProjectSession opened = open_project(command_, words_, Work{.callback = tell, .stop = pages.stop});
        console_.note(opened.messages.notes);
        for (const std::string& warning : opened.messages.warnings) console_.warn(warning);
        project_ = opened.session->project_path();
        return opened.session;
    }

    void end(const std::exception_ptr& failure) {
        const bool is_left_open = failure && leaves_a_choice(failure);
        {
            const std::scoped_lock lock(mutex_);
            has_ended_ = true;
            is_left_open_ = is_left_open;
            if (!is_left_open) failure_ = failure;
            if (server_) tell_end();
        }
        changed_.notify_all();
    }

    /// A folder that holds no volume, or several, or what was given up in the page, which then shows what there is to
    /// choose.
    bool leaves_a_choice(const std::exception_ptr& failure) {
        std::error_code ignored;
        const DicomSeriesOptions& dicom = command_.image.options.dicom;
        const bool is_folder = fs::is_directory(words_.image, ignored) && !dicom.series_uid && !dicom.volume;
        try {
            std::rethrow_exception(failure);
        } catch (const SecondImageError&) {
            return false;
        } catch (const Error& error) {
            // Cancelled in the page, not by Ctrl+C.
            if (error.kind() == ErrorKind::cancelled) return !console_.stop_token().stop_requested();
            if (!is_folder || error.kind() != ErrorKind::invalid_input) return false;
            console_.warn(error.what());
            workspace_->suggest(fs::absolute(words_.image), error.what());
            return true;
        } catch (const std::exception&) {
            return false;
        }
    }

    void tell_end() {
        if (failure_ && server_) server_->stop_soon();
        if (is_left_open_) console_.print(kChooseInPage);
        if (!project_.empty())
            console_.print(fmt::format("project {}; every edit is saved at once, Ctrl+C ends\n", project_.string()));
        std::fflush(stdout);
        project_.clear();
        is_left_open_ = false;
    }

    const OpenCommand& command_;
    const Words words_;
    Console& console_;
    viewer::Workspace* workspace_ = nullptr;
    mutable std::mutex mutex_;  ///< of what follows
    std::condition_variable changed_;
    viewer::Server* server_ = nullptr;
    fs::path project_;
    std::exception_ptr failure_;
    bool has_ended_ = false, is_left_open_ = false;
};

}  // namespace

void run(const OpenCommand& command, Console& console) {
    const Work work = console.work();
    viewer::remove_left_folders();
    const Words words = sorted_words(command);
    FirstImage first(command, words, console);
    viewer::Workspace workspace(services(command, words));
    const bool is_named = !words.is_empty();
    if (is_named) {
        first.begin(workspace);
        first.wait_for(kSilence);
        first.check();
    }

    if (!viewer::has_page())
        console.warn(
            "this kontur was built without its page, because Node.js or npm was missing: there is nothing to draw on");
    viewer::Server server(workspace, command.server);
    console.print(server.address() + "\n" + (is_named ? "" : kChooseInPage));
    flush_stdout();  // who does not learn the address cannot use it
    first.serve(&server);
    const auto way_in = command.no_browser ? nullptr : open_browser(server.address(), console);
    const StopCallback stop(work.stop, [&] { server.stop(); });
    server.run();
    first.serve(nullptr);
    workspace.cancel();
    first.wait_for(kPatience);
    first.check();
}

}  // namespace kontur::app
