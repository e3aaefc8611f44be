// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <functional>
#include <system_error>

#include "kontur/base/error.h"

namespace kontur::app {
namespace {

// request_stop() may lock, which a signal handler must not: the handler only writes to this pipe, a thread reads it.
std::array<int, 2> pipe_ends{-1, -1};

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
constexpr char kInterrupted = 'i';
constexpr char kFinished = 'f';

void send(char what) {
    while (write(pipe_ends[1], &what, 1) < 0 && errno == EINTR) {
    }
}

extern "C" void on_signal(int) {
    const int saved = errno;
    send(kInterrupted);
    errno = saved;
}

/// nohup starts programs so, for them to outlive their terminal.
bool is_ignored_hangup(int signal) {
    struct sigaction action = {};
    return signal == SIGHUP && sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void watch(StopSource& source) {
    for (char what = 0; what != kFinished;) {
        if (read(pipe_ends[0], &what, 1) < 0 && errno != EINTR) return;
        if (what == kInterrupted) source.request_stop();
    }
}

}  // namespace

Interrupt::Interrupt() {
    if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0)
        throw Error(ErrorKind::io, "cannot open a pipe: " + std::generic_category().message(errno));
    watcher_ = std::thread(watch, std::ref(source_));
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    for (const int signal : kSignals)
        if (!is_ignored_hangup(signal)) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
    for (const int signal : kSignals)
        if (!is_ignored_hangup(signal)) std::signal(signal, SIG_DFL);
    send(kFinished);
    watcher_.join();
    for (const int end : pipe_ends) close(end);
}

}  // namespace kontur::app
