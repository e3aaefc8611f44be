// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "kontur/base/error.h"
#include "usage_sentence.h"

namespace kontur::app {

void print_stderr(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stderr); }

void flush_stdout() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw Error(ErrorKind::io, "standard output cannot be written");
}

Console::Console(bool quiet, StopToken stop, std::vector<std::string> options)
    : quiet_(quiet), options_(std::move(options)), has_bar_(!quiet && isatty(STDERR_FILENO)), stop_(std::move(stop)) {}

Console::~Console() { clear_bar(); }

Work Console::work(int threads) {
    Work work{.threads = threads, .stop = stop_};
    if (has_bar_) work.callback = [this](std::string_view stage, double fraction) { draw(stage, fraction); };
    return work;
}

void Console::print(std::string_view text) {
    if (quiet_) return;
    const std::scoped_lock lock(mutex_);
    clear_bar();
    std::fwrite(text.data(), 1, text.size(), stdout);  // flush_stdout() tells whether it arrived
}

void Console::warn(std::string_view sentence) {
    const std::scoped_lock lock(mutex_);
    clear_bar();
    print_stderr(fmt::format("kontur: warning: {}\n", with_typed_options(std::string(sentence), options_)));
}

void Console::warn_once(std::string_view sentence) {
    if (warned_.emplace(sentence).second) warn(sentence);
}

void Console::note(std::span<const std::string> sentences) {
    if (quiet_) return;
    const std::scoped_lock lock(mutex_);
    clear_bar();
    for (const std::string& sentence : sentences)
        print_stderr(fmt::format("kontur: note: {}\n", with_typed_options(sentence, options_)));
}

ReadImageOptions Console::noting(ReadImageOptions options) {
    options.on_note = [this](std::string_view sentence) { note(std::array{std::string(sentence)}); };
    options.on_warning = [this](std::string_view sentence) { warn_once(sentence); };
    return options;
}

void Console::draw(std::string_view stage, double fraction) {
    const std::scoped_lock lock(mutex_);
    constexpr int kCells = 30;
    const double done = std::clamp(fraction, 0.0, 1.0);
    const int filled = static_cast<int>(done * kCells);
    std::string bar = fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %  {}", "", filled, "", kCells - filled, 100 * done, stage);
    if (bar == bar_) return;
    bar_ = std::move(bar);
    print_stderr(fmt::format("\r{}\x1b[K", bar_));
}

void Console::clear_bar() {
    if (bar_.empty()) return;
    bar_.clear();
    print_stderr("\r\x1b[K");
}

}  // namespace kontur::app
