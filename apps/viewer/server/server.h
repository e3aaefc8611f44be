// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "viewer/server/server_options.h"
#include "viewer/server/workspace.h"

namespace kontur::viewer {

struct ServerCore;

/// The page's server on 127.0.0.1 (docs/viewer-protocol.md). Hostile requests are refused before anything of them is used;
/// slow and flooding clients are cut off.
class Server {
public:
    /// Binds the port. Throws Error(io) when it is taken.
    Server(Workspace& workspace, const ServerOptions& options);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// What to open in a browser: http://127.0.0.1:PORT/#TOKEN
    std::string address() const;

    /// Serves until `stop` is called or nobody has used it for the idle time. Call once.
    void run();
    /// From any thread.
    void stop();
    /// The same in a second, so that pages still get what they were told.
    void stop_soon();

private:
    std::unique_ptr<ServerCore> core_;
};

}  // namespace kontur::viewer
