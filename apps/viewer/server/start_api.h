// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "kontur/base/stop.h"
#include "viewer/server/access.h"
#include "viewer/server/workspace.h"

namespace kontur::viewer {

/// Requests of the start page (docs/viewer-protocol.md): the bytes of the reply, JSON or, for a thumbnail, binary; nullopt
/// for an address of others. Errors are exceptions.
struct StartReply {
    std::string content_type;
    std::string body;
};
StartReply json_reply(const nlohmann::json& value);
std::optional<StartReply> start_api(Workspace& workspace, const std::string& method, const Target& target,
                                    const std::string& body, const StopToken& stop);

/// What the body of a request names to be opened.
OpenRequest open_request_from(const nlohmann::json& document);

}  // namespace kontur::viewer
