// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace kontur {

/// What went wrong, in the terms a caller can act on.
enum class ErrorKind {
    invalid_input,    ///< the caller's contours, options or arguments cannot be used
    unsupported,      ///< well-formed, but a variant that kontur does not handle
    corrupt_file,     ///< a file's content contradicts its format or itself
    io,               ///< the operating system refused to read or write
    singular_system,  ///< the linear system has no unique solution
    too_large,        ///< a stated limit on size, memory or count would be exceeded
    cancelled,        ///< the caller asked to stop
};

/// The one exception type of the library. `what()` is one sentence that names the thing, the number and the limit: printable
/// UTF-8 in one line of at most 1500 bytes, whatever text of a file the message quotes.
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, std::string_view message);

    ErrorKind kind() const noexcept { return kind_; }

    /// The same error with one line of context in front: "CONTEXT: MESSAGE".
    Error with_context(std::string_view context) const;

private:
    ErrorKind kind_;
};

/// The kind's name as it stands in reports and in Python, such as "invalid_input".
std::string_view name(ErrorKind kind) noexcept;

/// Process exit code of the kind (BSD sysexits where one fits): invalid_input 65, unsupported 69, corrupt_file 66,
/// io 74, singular_system 70, too_large 77, cancelled 130. Wrong command-line usage, which is no Error, is 64.
int exit_code(ErrorKind kind) noexcept;

}  // namespace kontur
