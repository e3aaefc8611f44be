// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/http_api.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <new>
#include <nlohmann/json.hpp>
#include <span>

#include "kontur/base/error.h"
#include "kontur/base/number_from_chars.h"
#include "kontur/base/printable.h"
#include "kontur/io/dicom/uneven_slices_error.h"
#include "kontur/io/images/frame_choice_error.h"
#include "kontur/io/images/transform_choice_error.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"
#include "viewer/server/gzip.h"
#include "viewer/server/page.h"
#include "viewer/server/start_api.h"
#include "viewer/store/places.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::uint64_t kLargestBody = 64 << 10, kLargestImport = 512 << 20;
constexpr std::size_t kMostViews = 64;

int status_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::invalid_input:
            return 400;
        case ErrorKind::unsupported:
            return 415;
        case ErrorKind::corrupt_file:
        case ErrorKind::singular_system:
            return 422;
        case ErrorKind::too_large:
            return 413;
        case ErrorKind::cancelled:
            return 409;
        case ErrorKind::io:
            break;
    }
    return 500;
}

/// To a page that asks for what is gone, of which it will hear. Of an error its browser would complain.
HttpReply nothing() { return {204, "", "", {}}; }

HttpReply not_found() { return error_reply(404, "not_found", "there is nothing at this address"); }

HttpReply binary(std::string bytes) { return {200, "application/octet-stream", std::move(bytes), {}}; }

HttpReply compressed(std::string_view bytes) {
    HttpReply reply = binary(gzipped(bytes));
    reply.headers.emplace_back("Content-Encoding", "gzip");
    return reply;
}

/// The file can be read once something is chosen, which `more` names.
HttpReply choice_reply(const Error& error, const json& more) {
    json told{{"kind", name(error.kind())}, {"message", error.what()}};
    told.update(more);
    return {status_of(error.kind()), "application/json", to_text({{"error", std::move(told)}}), {}};
}

template <class Make>
HttpReply guarded(Make make) {
    try {
        return make();
    } catch (const json::exception&) {
        return error_reply(400, "invalid_input", "the request is no JSON that kontur understands");
    } catch (const FrameChoiceError& error) {
        return choice_reply(error, {{"frames", error.frames()}});
    } catch (const TransformChoiceError& error) {
        return choice_reply(error, {{"transforms", true}});
    } catch (const UnevenSlicesError& error) {
        return choice_reply(error, {{"uneven", true}});
    } catch (const StructureRemoved&) {
        return nothing();
    } catch (const PathMissing& error) {
        return error_reply(404, std::string(name(error.kind())), error.what());
    } catch (const Error& error) {
        return error_reply(status_of(error.kind()), std::string(name(error.kind())), error.what());
    } catch (const std::bad_alloc&) {
        return error_reply(413, "too_large", "there is not enough memory for this");
    } catch (const std::exception& error) {
        return error_reply(500, "internal", error.what());
    }
}

std::optional<Id> whole_number(const std::string& text) {
    Id number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// Of the image, from 0.
std::optional<int> time_of(const Target& target) {
    const auto text = target.parameter("time");
    if (!text) return std::nullopt;
    constexpr Id kMost = 99'999;
    const auto time = whole_number(*text);
    if (!time || *time < 0 || *time > kMost)
        throw Error(ErrorKind::invalid_input, fmt::format("'time' is not a whole number from 0 to {}", kMost));
    return static_cast<int>(*time);
}

HttpReply page_file(const std::string& path) {
    const PageFile* file = find_page_file(path == "/" ? "/index.html" : path);
    if (!file) return not_found();
    return {200, std::string(file->content_type), std::string(file->gzip), {{"Content-Encoding", "gzip"}}};
}

/// The known extension that a file name ends with, in capitals or not. Nothing else of the name is used.
std::string known_extension(std::string_view file, std::span<const char* const> known) {
    const std::string name = lower_case(file);
    std::string list;
    for (const char* extension : known) {
        if (name.ends_with(extension)) return extension;
        list += (list.empty() ? "" : ", ") + std::string(extension);
    }
    throw Error(ErrorKind::unsupported, fmt::format("only files that end with {} can be imported here", list));
}

/// Of a slice, whose request has been checked.
bool wants_compressed(const std::string& slice) { return json::parse(slice).value("compressed", false); }

TraceRequest trace_request(const Target& target) {
    TraceRequest request;
    if (const auto planes = target.parameter("planes")) {
        const auto count = whole_number(*planes);
        if (!count || *count < 1 || *count > 200)
            throw Error(ErrorKind::invalid_input, "'planes' is not a whole number from 1 to 200");
        request.planes = static_cast<int>(*count);
    }
    if (const auto axes = target.parameter("axes")) {
        const auto has = [&](const char* axis) { return axes->find(axis) != std::string::npos; };
        request.axial = has("axial"), request.sagittal = has("sagittal"), request.coronal = has("coronal");
        if (!request.axial && !request.sagittal && !request.coronal)
            throw Error(ErrorKind::invalid_input, "'axes' names none of axial, sagittal and coronal");
    }
    request.preview = target.parameter("preview").has_value();
    return request;
}

Upload::Purpose purpose_of(const Target& target) {
    const std::string word = target.parameter("as").value_or("contours");
    if (word == "correct") return Upload::Purpose::correct;
    if (word == "contours") return Upload::Purpose::contours;
    throw Error(ErrorKind::invalid_input, fmt::format("'as' is \"{}\"; contours or correct is needed", word));
}

}  // namespace

HttpReply error_reply(int status, const std::string& kind, const std::string& message) {
    return {status, "application/json", to_text({{"error", {{"kind", kind}, {"message", message}}}}) + "\n", {}};
}

std::vector<std::pair<std::string, std::string>> security_headers(const std::string& host) {
    return {
        {"Content-Security-Policy", "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws://" + host +
                                        "; frame-ancestors 'none'; base-uri 'none'; form-action 'none'; object-src 'none'"},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cache-Control", "no-store"}};
}

std::uint64_t HttpApi::body_limit(std::string_view path) {
    return path.starts_with("/api/import/") ? kLargestImport : kLargestBody;
}

HttpApi::View HttpApi::view_of(const std::string& slice) {
    const json request = json::parse(slice, nullptr, false);
    const auto text = [&](const char* key) {
        const bool is_text = request.is_object() && request.contains(key) && request[key].is_string();
        return is_text ? request[key].get<std::string>().substr(0, 64) : std::string();
    };
    const bool is_numbered = request.is_object() && request.contains("image") && request["image"].is_number_integer();
    return {text("page"), text("view"), is_numbered ? request["image"].get<std::int64_t>() : 0};
}

std::function<HttpReply(const StopToken&)> HttpApi::prepare(HttpRequest request) {
    if (request.method != "POST" || request.target.path != "/api/slice")
        return [this, request = std::move(request)](const StopToken& stop) { return handle(request, stop); };
    const View view = view_of(request.body);
    std::uint64_t ticket = 0;
    {
        const std::scoped_lock lock(mutex_);
        if (newest_slice_.size() >= kMostViews && !newest_slice_.contains(view)) newest_slice_.clear();
        ticket = newest_slice_[view] = ++next_ticket_;
    }
    return [this, request = std::move(request), view, ticket](const StopToken&) { return slice(request, ticket, view); };
}

HttpReply HttpApi::slice(const HttpRequest& request, std::uint64_t ticket, const View& view) {
    return guarded([&]() -> HttpReply {
        {
            const std::scoped_lock lock(mutex_);
            if (const auto newest = newest_slice_.find(view); newest != newest_slice_.end() && newest->second > ticket)
                throw Error(ErrorKind::cancelled, "a later slice of this view was asked for");
        }
        const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
        if (!session) return nothing();
        std::string bytes = session->slice(request.body);
        return wants_compressed(request.body) ? compressed(bytes) : binary(std::move(bytes));
    });
}

HttpReply HttpApi::handle(const HttpRequest& request, const StopToken& stop) {
    return guarded([&]() -> HttpReply {
        if (request.target.path.starts_with("/api/")) return api(request, stop);
        return request.method == "GET" ? page_file(request.target.path) : not_found();
    });
}

HttpReply HttpApi::api(const HttpRequest& request, const StopToken& stop) {
    const Target& target = request.target;
    const bool get = request.method == "GET";
    const auto below = [&](std::string_view folder) { return target.path.starts_with(folder); };
    if (get && below("/api/mesh/")) return mesh(request);
    if (get && target.path == "/api/statistics") return measured(request, stop);
    if (get && target.path == "/api/compare") return compared(request, stop);
    if (get && below("/api/export/")) return exported(request, stop);
    if (get && target.path == "/api/drawings") return drawings(request, stop);
    if (!get && below("/api/import/")) return import(request, stop);
    if (!get && target.path == "/api/image") return put_image(request, stop);
    if (get && target.path == "/api/archive/arriving") return arriving(target);
    if (!get && target.path == "/api/archive/send") return send(request, stop);
    if (get && target.path == "/api/archive/waiting")
        return {200, "application/json", to_text({{"names", workspace_.waiting_for_archive(request.opening)}}), {}};
    if (auto reply = start_api(workspace_, request.method, target, request.body, stop))
        return {200, std::move(reply->content_type), std::move(reply->body), {}};
    return not_found();
}

HttpReply HttpApi::mesh(const HttpRequest& request) {
    const Target& target = request.target;
    const auto id = whole_number(target.path.substr(std::string_view("/api/mesh/").size()));
    if (!id) return not_found();
    const auto other = target.parameter("far_from");
    const std::optional<Id> far_from = other ? whole_number(*other) : std::nullopt;
    if (other && !far_from) throw Error(ErrorKind::invalid_input, "'far_from' is not a whole number");
    const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
    if (!session) return nothing();
    if (!target.parameter("coded")) return binary(session->mesh(*id, false, {.widths = true, .time = time_of(target)}));
    std::string bytes = session->mesh(
        *id, true,
        {target.parameter("widths").has_value(), target.parameter("origins").has_value(), far_from, time_of(target)});
    return target.parameter("compressed") ? compressed(bytes) : binary(std::move(bytes));
}

HttpReply HttpApi::measured(const HttpRequest& request, const StopToken& stop) {
    const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
    if (!session) return nothing();
    return {200, "application/json", session->statistics(stop, time_of(request.target)), {}};
}

HttpReply HttpApi::put_image(const HttpRequest& request, const StopToken& stop) {
    const json document = parsed_request(request.body, "ImageRequest");
    workspace_.put_second_image(open_request_from(document), request.opening, stop);
    return {200, "application/json", "{}", {}};
}

HttpReply HttpApi::send(const HttpRequest& request, const StopToken& stop) {
    const json document = parsed_request(request.body, "SendRequest");
    const ArchiveOutbox::Item item{document["name"].get<std::string>(), document.value("again", false)};
    return {200, "application/json", to_text(workspace_.send_to_archive(item, request.opening, stop)), {}};
}

HttpReply HttpApi::arriving(const Target& target) {
    std::optional<double> at_mm;
    if (const auto text = target.parameter("at_mm")) {
        const auto [end, error] = number_from_chars(text->data(), text->data() + text->size(), at_mm.emplace());
        if (error != std::errc() || end != text->data() + text->size() || !std::isfinite(*at_mm))
            throw Error(ErrorKind::invalid_input, "'at_mm' is not a number");
    }
    std::string bytes = workspace_.arriving(at_mm);
    return bytes.empty() ? nothing() : binary(std::move(bytes));
}

HttpReply HttpApi::compared(const HttpRequest& request, const StopToken& stop) {
    const auto id = [&](const char* name) {
        const auto text = request.target.parameter(name);
        const auto number = text ? whole_number(*text) : std::nullopt;
        if (!number) throw Error(ErrorKind::invalid_input, fmt::format("'{}' is not a whole number", name));
        return *number;
    };
    const Id first = id("first"), second = id("second");
    const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
    if (!session) return nothing();
    return {200, "application/json", session->compare(first, second, stop, time_of(request.target)), {}};
}

HttpReply HttpApi::exported(const HttpRequest& request, const StopToken& stop) {
    const Target& target = request.target;
    std::optional<Id> structure;
    if (const auto text = target.parameter("structure")) {
        structure = whole_number(*text);
        if (!structure) throw Error(ErrorKind::invalid_input, "'structure' is not a whole number");
    }
    const std::string name = target.path.substr(std::string_view("/api/export/").size());
    const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
    if (!session) return nothing();
    Download download = session->exported(name, structure, stop, time_of(target));
    return {200,
            download.content_type,
            std::move(download.bytes),
            {{"Content-Disposition", fmt::format("attachment; filename=\"{}\"", download.file_name)}}};
}

HttpReply HttpApi::drawings(const HttpRequest& request, const StopToken& stop) {
    const std::shared_ptr<Session> session = workspace_.session_unless_closed(request.opening);
    if (!session) return nothing();
    return {200, "application/json", session->drawings(stop), {}};
}

HttpReply HttpApi::import(const HttpRequest& request, const StopToken& stop) {
    const Target& target = request.target;
    const bool anyway = target.parameter("anyway").has_value();
    const std::string file = target.parameter("name").value_or("");
    Upload upload{.trace = trace_request(target), .anyway = anyway, .file = file, .purpose = purpose_of(target)};
    ImportReply reply;
    if (target.path == "/api/import/near") {
        reply = workspace_.session(request.opening)->import_near(target.parameter("file").value_or(""), upload, stop);
    } else if (target.path == "/api/import/contours") {
        upload.extension = known_extension(file, kContourEndings);
        reply = workspace_.session(request.opening)->import(request.body, upload, stop);
    } else if (target.path == "/api/import/mask") {
        upload.content = Upload::Content::mask;
        upload.extension = known_extension(file, kMaskEndings);
        reply = workspace_.session(request.opening)->import(request.body, upload, stop);
    } else {
        return not_found();
    }
    json answer{{"structures", reply.structures}, {"doubts", reply.doubts}, {"notes", reply.notes}};
    for (const TracedMask& one : reply.traced)
        answer["traced"].push_back(
            {{"name", one.name}, {"volume_ml", one.volume_ml}, {"traced_ml", one.traced_ml}, {"dice", one.dice}});
    return {200, "application/json", to_text(answer), {}};
}

}  // namespace kontur::viewer
