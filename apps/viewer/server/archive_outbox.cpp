// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/archive_outbox.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "archive/send.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/dicom/dicom_object.h"
#include "viewer/model/temporary_files.h"

namespace kontur::viewer {
namespace {

using archive::Outcome;

std::string key_of(const Session& session, const std::string& name) { return session.project_path().string() + "\n" + name; }

nlohmann::json answer(const archive::Sent& sent, const std::string& host) {
    switch (sent.outcome) {
        case Outcome::stored:
            return {{"outcome", "stored"}, {"text", fmt::format("{} has stored it in the study of the image.", host)}};
        case Outcome::stored_with_doubt:
            return {{"outcome", "doubt"},
                    {"text", fmt::format("{} has stored it in the study of the image, but {}.", host, sent.reason)}};
        case Outcome::was_there:
            return {{"outcome", "stored"}, {"text", fmt::format("{} had it already; nothing was sent.", host)}};
        case Outcome::refused:
            break;
    }
    return {{"outcome", "refused"}, {"text", fmt::format("{} refused it: {}.", host, sent.reason)}};
}

}  // namespace

nlohmann::json ArchiveOutbox::send(const NamedArchive& named, Session& session, const Item& item, const StopToken& stop) {
    const std::string key = key_of(session, item.name);
    std::string bytes = bytes_of(session, item, stop);
    const TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / item.name;
    write_file_atomically(file, bytes);
    const DicomObject object = dicom_object(file);
    {
        const std::scoped_lock lock(mutex_);
        kept_[key] = std::move(bytes);
    }
    archive::Http http(named.service, named.access);
    const archive::Sent sent = archive::send_object(http, file, object, {.stop = stop});
    const std::scoped_lock lock(mutex_);
    kept_.erase(key);
    return answer(sent, named.service.host());
}

std::string ArchiveOutbox::bytes_of(Session& session, const Item& item, const StopToken& stop) {
    if (item.is_again) {
        const std::scoped_lock lock(mutex_);
        if (const auto kept = kept_.find(key_of(session, item.name)); kept != kept_.end()) return kept->second;
    }
    return session.exported(item.name, std::nullopt, stop).bytes;
}

}  // namespace kontur::viewer
