// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kontur::app {

/// How to start a program with the signals as they were before this one began to ignore some, and with further
/// POSIX_SPAWN flags.
class SpawnAttributes {
public:
    explicit SpawnAttributes(short flags = 0);
    ~SpawnAttributes();
    SpawnAttributes(const SpawnAttributes&) = delete;
    SpawnAttributes& operator=(const SpawnAttributes&) = delete;

    const posix_spawnattr_t* get() const { return &attributes_; }

private:
    posix_spawnattr_t attributes_;
};

/// This program run again with other words, in a process of its own: whatever becomes of it, this one goes on.
class ChildProcess {
public:
    /// Standard output is thrown away, standard error goes to `log`. Throws Error(io).
    ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& folder,
                 const std::filesystem::path& log);
    /// Ends it if it still runs, and waits for that.
    ~ChildProcess();
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess& operator=(ChildProcess&&) = delete;

    /// Its exit code when it has ended, 128 + N when signal N ended it.
    std::optional<int> exit_code();

private:
    pid_t id_ = 0;  ///< 0: none, or it has ended
};

}  // namespace kontur::app
