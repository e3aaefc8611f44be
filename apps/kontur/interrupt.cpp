// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <functional>
#include <system_error>

namespace kontur::app {
namespace {

// request_stop() may lock, which a signal handler must not: the handler only writes to this pipe, a thread reads it.
std::array<int, 2> pipe_ends{-1, -1};

constexpr std::array kSignals{SIGINT, SIGTERM};
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

void watch(std::stop_source& source) {
    for (char what = 0; what != kFinished;) {
        if (read(pipe_ends[0], &what, 1) < 0 && errno != EINTR) return;
        if (what == kInterrupted) source.request_stop();
    }
}

}  // namespace

Interrupt::Interrupt() {
    if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    watcher_ = std::thread(watch, std::ref(source_));
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

Interrupt::~Interrupt() {
    for (const int signal : kSignals) std::signal(signal, SIG_DFL);
    send(kFinished);
    watcher_.join();
    for (const int end : pipe_ends) close(end);
}

}  // namespace kontur::app
