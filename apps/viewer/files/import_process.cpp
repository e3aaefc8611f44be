// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/import_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <thread>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr rlim_t kMostMemory = rlim_t{8} << 30;
constexpr rlim_t kLargestResult = rlim_t{256} << 20;
constexpr rlim_t kMostProcessorSeconds = 600;
constexpr std::chrono::seconds kPatience{300};

/// Address sanitizers reserve terabytes, and would die of a limit that a plain build never meets.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitsMemory = false;
#elif defined(__has_feature)  // clang's way to say so
constexpr bool kLimitsMemory = !__has_feature(address_sanitizer) && !__has_feature(thread_sanitizer);
#else
constexpr bool kLimitsMemory = true;
#endif

void limit(int what, rlim_t most) {
    rlimit now{};
    getrlimit(what, &now);
    const rlimit lower{std::min(most, now.rlim_max), std::min(most, now.rlim_max)};
    setrlimit(what, &lower);
}

/// Nothing of the server's may be in reach of what reads a foreign file, nor may it outlive the server, not even one that
/// ended while this process began.
void limit_this_process(pid_t server) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != server) _exit(exit_code(ErrorKind::io));
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    close_range(STDERR_FILENO + 1, ~0U, 0);
    if (kLimitsMemory) limit(RLIMIT_AS, kMostMemory);
    limit(RLIMIT_CPU, kMostProcessorSeconds);
    limit(RLIMIT_FSIZE, kLargestResult);
    limit(RLIMIT_CORE, 0);
    signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit then fails, and is told as such
}

constexpr int kWords = 11;

std::vector<std::string> words_of(const Upload& upload) {
    std::string axes;
    if (upload.trace.axial) axes += 'a';
    if (upload.trace.sagittal) axes += 's';
    if (upload.trace.coronal) axes += 'c';
    return {"kontur",
            kImportWorker,
            upload.content == Upload::Content::mask ? "mask" : "contours",
            upload.extension,
            std::to_string(upload.trace.planes),
            axes,
            upload.trace.preview ? "preview" : "import",
            upload.purpose == Upload::Purpose::correct ? "correct" : "contours",
            upload.images,
            upload.series_uid,
            std::to_string(getpid())};
}

Upload upload_from(char** words) {
    const std::string_view content = words[2], axes = words[5], purpose = words[7];
    const auto has = [&](char axis) { return axes.find(axis) != std::string_view::npos; };
    return {content == "mask" ? Upload::Content::mask : Upload::Content::contours,
            words[3],
            {std::atoi(words[4]), has('a'), has('s'), has('c'), std::string_view(words[6]) == "preview"},
            false,
            {},
            purpose == "correct" ? Upload::Purpose::correct : Upload::Purpose::contours,
            words[8],
            words[9]};
}

/// The process that reads; killed where it is no longer wanted.
class Worker {
public:
    Worker(const Upload& upload, const fs::path& folder) {
        std::vector<std::string> words = words_of(upload);
        std::vector<char*> argv(words.size() + 1, nullptr);
        std::transform(words.begin(), words.end(), argv.begin(), [](std::string& word) { return word.data(); });
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        const int failure = posix_spawn(&id_, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (failure != 0) {
            id_ = 0;
            throw Error(ErrorKind::io, fmt::format("cannot start a process to read the file: {}", std::strerror(failure)));
        }
    }
    ~Worker() {
        if (id_ == 0) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Its status as `waitpid` tells it.
    int wait(const Work& work) {
        const Clock::time_point start = Clock::now();
        int status = 0;
        for (std::chrono::milliseconds pause(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
            if (waitpid(id_, &status, WNOHANG) == id_) break;
            work.check();
            if (Clock::now() - start > kPatience) {
                throw Error(ErrorKind::too_large,
                            fmt::format("reading the file took longer than {} s, and was given up", kPatience.count()));
            }
            std::this_thread::sleep_for(pause);
        }
        id_ = 0;
        return status;
    }

private:
    pid_t id_ = 0;
};

}  // namespace

int run_import_process(const Upload& upload, const fs::path& folder, const Work& work) {
    return Worker(upload, folder).wait(work);
}

void check_ended_in_time(int status) {
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        throw Error(ErrorKind::too_large, fmt::format("reading the file took more than {} s of computing, and was given up",
                                                      static_cast<std::uint64_t>(kMostProcessorSeconds)));
}

std::optional<Upload> begin_import_process(int argc, char** argv) {
    if (argc != kWords) return std::nullopt;
    limit_this_process(std::atoi(argv[10]));
    return upload_from(argv);
}

}  // namespace kontur::viewer
