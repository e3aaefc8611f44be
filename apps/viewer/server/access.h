// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Who may talk to the server: a web page of another origin, or a name that an attacker points at 127.0.0.1, may not.

namespace kontur::viewer {

/// A request's target in parts, percent-decoding done. nullopt for what is no path that starts with '/'.
struct Target {
    std::string path;
    std::vector<std::pair<std::string, std::string>> query;

    std::optional<std::string> parameter(std::string_view name) const;
};
std::optional<Target> parse_target(std::string_view target);

/// What the checks look at: values as the request has them, one for each time that a header is repeated.
struct RequestHead {
    std::string method;
    std::optional<Target> target;  ///< the one that is answered: two readings of it would be a way around the checks
    std::vector<std::string> host, origin, authorization, protocols;
    bool is_upgrade = false;
};

struct Refusal {
    int status = 0;
    std::string kind;
    std::string message;
};

/// The address and the secret of one server.
struct Access {
    std::uint16_t port = 0;
    std::string token;
};

/// The first check of docs/viewer-protocol.md that fails: Host, Origin, token, method.
std::optional<Refusal> refusal(const RequestHead& head, const Access& access);

/// Whether the request shows the secret, as only the user's own programs can.
bool shows_token(const RequestHead& head, const Access& access);

/// 128 random bits in hexadecimal.
std::string random_token();

}  // namespace kontur::viewer
