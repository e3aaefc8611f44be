// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kontur::archive {

/// Who asks an archive. No member goes into a message.
struct Credentials {
    std::string user, password;  ///< empty: none
    std::string token;           ///< a bearer token (RFC 6750); empty: none
    std::string origin;          ///< where they come from, for messages: "--credentials FILE"

    bool is_empty() const { return user.empty() && token.empty(); }
};

/// The variable that holds what a file of credentials holds.
inline constexpr const char* kCredentialsVariable = "KONTUR_ARCHIVE_CREDENTIALS";

/// From a file of one line, "user:password" or "Bearer TOKEN". An empty path: from the variable; none where that is unset.
/// Throws Error(io) for a file that cannot be read, Error(invalid_input) for one that others may read too, and for another
/// content, which is not quoted.
Credentials read_credentials(const std::filesystem::path& file);

}  // namespace kontur::archive
