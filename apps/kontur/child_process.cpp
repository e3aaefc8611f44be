// SPDX-License-Identifier: Apache-2.0
#include "child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <utility>

#include "interrupt.h"
#include "kontur/base/error.h"

namespace kontur::app {
namespace {

int to_exit_code(int status) { return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status); }

}  // namespace

SpawnAttributes::SpawnAttributes(short flags) {
    sigset_t ignored;
    sigemptyset(&ignored);
    for (const int signal : kIgnoredSignals) sigaddset(&ignored, signal);
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setsigdefault(&attributes_, &ignored);
    posix_spawnattr_setflags(&attributes_, static_cast<short>(flags | POSIX_SPAWN_SETSIGDEF));
}

SpawnAttributes::~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& folder,
                           const std::filesystem::path& log) {
    std::vector<std::string> all{"kontur"};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    argv.reserve(all.size() + 1);
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    const int failure = posix_spawn(&id_, "/proc/self/exe", &actions, SpawnAttributes().get(), argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
        id_ = 0;
        throw Error(ErrorKind::io, fmt::format("cannot start a process: {}", std::strerror(failure)));
    }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

ChildProcess::~ChildProcess() {
    if (id_ == 0) return;
    kill(id_, SIGTERM);
    waitpid(id_, nullptr, 0);
}

std::optional<int> ChildProcess::exit_code() {
    int status = 0;
    if (waitpid(id_, &status, WNOHANG) != id_) return std::nullopt;
    id_ = 0;
    return to_exit_code(status);
}

}  // namespace kontur::app
