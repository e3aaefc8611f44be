// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace kontur::viewer {

struct ServerOptions {
    std::uint16_t port = 0;      ///< 0: any free one
    std::string token = {};      ///< empty: a random one
    int idle_timeout_s = 0;      ///< ends after this time without an open page; 0: never
    int most_connections = 32;   ///< further ones are closed at once
    int request_timeout_s = 10;  ///< for a request to arrive; imports get a second more for each MiB
    int reply_timeout_s = 30;    ///< for a reply to be taken, likewise
    int keep_alive_s = 60;       ///< how long a connection may be silent between requests
};

}  // namespace kontur::viewer
