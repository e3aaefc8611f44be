// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/stop.h"
#include "kontur/base/work.h"
#include "kontur/io/images/read_image_options.h"

namespace kontur::app {

/// Text on stderr, as far as that can be written: whoever closed it wants no words, but the work done.
void print_stderr(const std::string& text);

/// What was printed must have arrived: a full disk or a closed pipe behind stdout is a failure like any other. Throws
/// Error(io).
void flush_stdout();

/// What a command says to the person at the terminal: results on stdout, warnings and a progress bar on stderr. Safe for
/// concurrent use.
class Console {
public:
    /// `quiet`: no progress and no results, warnings only. `options`: the long ones of the command, which sentences name.
    Console(bool quiet, StopToken stop, std::vector<std::string> options);
    ~Console();
    Console(const Console&) = delete;
    Console& operator=(const Console&) = delete;

    /// For long library calls, on so many threads (0: the machine's): cancelled by Ctrl-C, drawn as a bar when stderr is a
    /// terminal.
    Work work(int threads = 0);

    /// What `work` is cancelled by.
    const StopToken& stop_token() const { return stop_; }

    /// Text on stdout, unless quiet.
    void print(std::string_view text);
    /// One line on stderr, "kontur: warning: SENTENCE".
    void warn(std::string_view sentence);
    /// The same, unless it was said before: some inputs are read twice.
    void warn_once(std::string_view sentence);
    /// What was decided for the user, one line each on stderr, unless quiet.
    void note(std::span<const std::string> sentences);
    /// The options with what their reader decides told as notes, and what it doubts as warnings.
    ReadImageOptions noting(ReadImageOptions options);

private:
    void draw(std::string_view stage, double fraction);
    void clear_bar();

    bool quiet_;
    std::vector<std::string> options_;
    bool has_bar_;
    StopToken stop_;
    std::set<std::string, std::less<>> warned_;
    std::mutex mutex_;  ///< of the terminal
    std::string bar_;   ///< what stands on the terminal's last line; empty: nothing
};

}  // namespace kontur::app
