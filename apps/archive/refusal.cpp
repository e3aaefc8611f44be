// SPDX-License-Identifier: Apache-2.0
#include "archive/refusal.h"

#include <fmt/format.h>

namespace kontur::archive {
namespace {

std::string not_let_in(const Http& http) {
    const Credentials& who = http.access().credentials;
    const std::string host = http.service().host();
    return who.is_empty() ? fmt::format(
                                "{} wants to know who asks; name a file that holds user:password or Bearer TOKEN with "
                                "--credentials, or put that into {}",
                                host, kCredentialsVariable)
                          : fmt::format("{} does not accept the user or token of {}", host, who.origin);
}

}  // namespace

Error refusal(const Answer& answer, const Http& http, const std::string& what) {
    const std::string host = http.service().host();
    switch (answer.status) {
        case 401:
            return {ErrorKind::io, not_let_in(http)};
        case 403:
            return {ErrorKind::io,
                    fmt::format("{} does not let this user do that with {}; ask those who run it", host, what)};
        case 404:
        case 410:
            return {ErrorKind::invalid_input, fmt::format("{} does not have {}", host, what)};
        case 409:
            return {ErrorKind::io, fmt::format("{} refuses {}: it contradicts what is there (409)", host, what)};
        case 413:
            return {ErrorKind::too_large, fmt::format("{} takes nothing as large as {} (413)", host, what)};
        default:
            return {ErrorKind::io, fmt::format("{} answers {} with status {}", host, what, answer.status)};
    }
}

}  // namespace kontur::archive
