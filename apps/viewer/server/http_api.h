// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "kontur/base/stop.h"
#include "viewer/server/access.h"
#include "viewer/server/workspace.h"

namespace kontur::viewer {

struct HttpRequest {
    std::string method;
    Target target;
    std::string body;
    std::optional<std::string> opening{};  ///< which session the page was greeted by, if it says so
};

struct HttpReply {
    int status = 200;
    std::string content_type;
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers;  ///< besides those that every reply has
};

/// HTTP requests, already admitted by `refusal`, to replies. Safe for concurrent use; never throws.
class HttpApi {
public:
    explicit HttpApi(Workspace& workspace) : workspace_(workspace) {}

    /// Largest body in bytes of a request to this path.
    static std::uint64_t body_limit(std::string_view path);

    /// To be called when a request has come, before it waits for its turn: of the slices asked for one view of a
    /// page, only the latest is made. Returns what handles it; whoever calls that requests the stop when nobody waits for
    /// the reply.
    std::function<HttpReply(const StopToken&)> prepare(HttpRequest request);

private:
    HttpReply handle(const HttpRequest& request, const StopToken& stop);
    HttpReply api(const HttpRequest& request, const StopToken& stop);
    /// A page's own name, its view's, and the image's number: two pages have views of the same names, and a view shows
    /// several images.
    using View = std::tuple<std::string, std::string, std::int64_t>;
    static View view_of(const std::string& slice);

    HttpReply slice(const HttpRequest& request, std::uint64_t ticket, const View& view);
    HttpReply mesh(const HttpRequest& request);
    HttpReply measured(const HttpRequest& request, const StopToken& stop);
    HttpReply put_image(const HttpRequest& request, const StopToken& stop);
    HttpReply send(const HttpRequest& request, const StopToken& stop);
    HttpReply arriving(const Target& target);
    HttpReply compared(const HttpRequest& request, const StopToken& stop);
    HttpReply exported(const HttpRequest& request, const StopToken& stop);
    HttpReply drawings(const HttpRequest& request, const StopToken& stop);
    HttpReply import(const HttpRequest& request, const StopToken& stop);

    Workspace& workspace_;
    std::mutex mutex_;
    std::map<View, std::uint64_t> newest_slice_;
    std::uint64_t next_ticket_ = 0;
};

/// `{"error": {"kind", "message"}}` with its status.
HttpReply error_reply(int status, const std::string& kind, const std::string& message);

/// Headers of every reply that the browser enforces (docs/viewer-protocol.md).
std::vector<std::pair<std::string, std::string>> security_headers(const std::string& host);

}  // namespace kontur::viewer
