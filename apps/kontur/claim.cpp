// SPDX-License-Identifier: Apache-2.0
#include "claim.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "kontur/base/error.h"

namespace kontur::app {

std::optional<Claim> Claim::on(const std::filesystem::path& file) {
    constexpr int kEveryones = 0666;  // less what the user's umask takes away
    // Writable, or NFS gives no exclusive lock; closed in the processes that are started, which would keep it.
    const int opened = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kEveryones);
    if (opened < 0)
        throw Error(ErrorKind::io,
                    fmt::format("cannot write {}: {}", file.string(), std::generic_category().message(errno)));
    const bool is_locked = flock(opened, LOCK_EX | LOCK_NB) == 0;
    const bool is_anothers = !is_locked && errno == EWOULDBLOCK;
    Claim claim(opened, is_locked);
    if (is_anothers) return std::nullopt;
    return claim;
}

Claim::~Claim() {
    if (file_ >= 0) close(file_);
}

Claim::Claim(Claim&& other) noexcept : file_(std::exchange(other.file_, -1)), is_locked_(other.is_locked_) {}

}  // namespace kontur::app
