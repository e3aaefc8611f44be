// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/start_api.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/images/dicom_choice.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"
#include "viewer/server/archive_api.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

std::string needed(const Target& target, const char* name) {
    const auto value = target.parameter(name);
    if (!value || value->empty()) throw Error(ErrorKind::invalid_input, fmt::format("'{}' is missing", name));
    return *value;
}

std::int64_t frame_of(const Target& target) {
    const std::string text = target.parameter("frame").value_or("1");
    std::int64_t frame = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
    if (error != std::errc() || end != text.data() + text.size())
        throw Error(ErrorKind::invalid_input, "'frame' is not a whole number");
    return frame;
}

void keep_arrangement(Workspace& workspace, const std::string& body) {
    const json document = parsed_request(body, "ArrangementRequest");
    workspace.arrangements().keep(document["modality"].get<std::string>(), document["state"]);
}

void open_archived(Workspace& workspace, const std::string& body) {
    const json document = parsed_request(body, "ArchivedRequest");
    const auto uid = [&](const char* name) { return checked_uid(document[name].get<std::string>(), name); };
    workspace.open_archived(uid("study"), uid("series"), document["title"].get<std::string>());
}

/// Says in all pages how far the search is, as long as it lives.
class SearchStatus {
public:
    explicit SearchStatus(Workspace& workspace) : workspace_(workspace) {}
    ~SearchStatus() { workspace_.tell_status("", std::nullopt); }
    SearchStatus(const SearchStatus&) = delete;
    SearchStatus& operator=(const SearchStatus&) = delete;

    Work work(const StopToken& stop) {
        return {.callback =
                    [this](std::string_view, double done) {
                        const int percent = static_cast<int>(100 * done);
                        if (percent != std::exchange(last_, percent))
                            workspace_.tell_status("Looking through DICOM files", percent / 100.0);
                    },
                .stop = stop};
    }

private:
    Workspace& workspace_;
    int last_ = -1;
};

}  // namespace

StartReply json_reply(const json& value) { return {"application/json", to_text(value)}; }

OpenRequest open_request_from(const json& document) {
    // Of a second image it is a number.
    const bool is_moved = document.contains("image") && document["image"].is_string();
    return {document["path"].get<std::string>(), choice_from_json(document),
            is_moved ? document["image"].get<std::string>() : ""};
}

std::optional<StartReply> start_api(Workspace& workspace, const std::string& method, const Target& target,
                                    const std::string& body, const StopToken& stop) {
    const Places& places = workspace.places();
    if (method == "GET" && target.path == "/api/folder") return json_reply(places.list(needed(target, "path")));
    if (method == "GET" && target.path == "/api/series") {
        const auto folder = places.resolved(needed(target, "path"));
        SearchStatus status(workspace);
        return json_reply({{"path", folder.string()}, {"volumes", dicom_volumes(folder, status.work(stop))}});
    }
    if (method == "GET" && target.path == "/api/thumbnail")
        return StartReply{"application/octet-stream", (target.parameter("volume") ? frame_thumbnail : thumbnail)(
                                                          places.resolved(needed(target, "file")), frame_of(target))};
    if (method == "GET" && target.path.starts_with("/api/archive/")) return archive_api(workspace.archive(), target, stop);
    if (method != "POST") return std::nullopt;
    if (target.path == "/api/open") workspace.open(open_request_from(parsed_request(body, "OpenRequest")));
    else if (target.path == "/api/archive/open") open_archived(workspace, body);
    else if (target.path == "/api/cancel") workspace.cancel();
    else if (target.path == "/api/close") workspace.close();
    else if (target.path == "/api/arrangement") keep_arrangement(workspace, body);
    else return std::nullopt;
    return json_reply(json::object());
}

}  // namespace kontur::viewer
