// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

namespace kontur::app {

/// The right to do what a file stands for, which one process at a time has: a lock on the file, which a process gives back
/// when it ends, however it does.
class Claim {
public:
    /// nullopt: another process has it. Makes the file where it is not there; throws Error(io) where it cannot.
    static std::optional<Claim> on(const std::filesystem::path& file);
    ~Claim();
    Claim(Claim&& other) noexcept;
    Claim& operator=(Claim&&) = delete;

    /// False on a file system without locks, where everyone has the right.
    bool excludes_others() const { return is_locked_; }

private:
    Claim(int file, bool is_locked) : file_(file), is_locked_(is_locked) {}

    int file_ = -1;  ///< -1: moved from
    bool is_locked_ = false;
};

}  // namespace kontur::app
