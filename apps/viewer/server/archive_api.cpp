// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/archive_api.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "archive/query.h"
#include "archive/rendered.h"
#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

using archive::Address;
using archive::Http;
using nlohmann::json;

std::string uid_of(const Target& target, const char* name) { return checked_uid(target.parameter(name).value_or(""), name); }

StartReply studies(Http& http, const Target& target, const Work& work) {
    const auto text = [&](const char* name) { return target.parameter(name).value_or(""); };
    const archive::Studies all = archive::find_studies(
        http, {.name = text("name"), .patient_id = text("id"), .date = text("date"), .modality = text("modality")}, work);
    json list = json::array();
    for (const archive::Study& one : all.found)
        list.push_back({{"uid", one.uid},
                        {"patient_name", one.patient_name},
                        {"patient_id", one.patient_id},
                        {"date", one.date},
                        {"description", one.description},
                        {"modalities", one.modalities},
                        {"objects", one.instances}});
    return json_reply({{"studies", list}, {"has_more", all.has_more}});
}

StartReply series(Http& http, const Target& target, const Work& work) {
    json list = json::array();
    for (const archive::Series& one : archive::find_series(http, uid_of(target, "study"), work))
        list.push_back({{"uid", one.uid},
                        {"modality", one.modality},
                        {"number", one.number},
                        {"description", one.description},
                        {"objects", one.instances},
                        {"shows_images", archive::shows_images(one)}});
    return json_reply({{"series", list}});
}

}  // namespace

std::string checked_uid(std::string uid, std::string_view name) {
    if (!archive::is_uid(uid)) throw Error(ErrorKind::invalid_input, fmt::format("'{}' is no UID", name));
    return uid;
}

std::optional<StartReply> archive_api(const NamedArchive& named, const Target& target, const StopToken& stop) {
    Http http(named.service, named.access);
    const Work work{.stop = stop};
    if (target.path == "/api/archive/studies") return studies(http, target, work);
    if (target.path == "/api/archive/series") return series(http, target, work);
    if (target.path != "/api/archive/picture") return std::nullopt;
    const Address address{named.service.service, uid_of(target, "study"), uid_of(target, "series"), ""};
    return StartReply{"image/jpeg", archive::picture_of(http, address, work)};
}

}  // namespace kontur::viewer
