// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/archive_outbox.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "archive/send.h"
#include "kontur/base/error.h"
#include "kontur/io/bytes/atomic_file.h"
#include "kontur/io/dicom/dicom_object.h"
#include "kontur/shape/sha256.h"

namespace kontur::viewer {
namespace {

using archive::Outcome;

namespace fs = std::filesystem;

constexpr std::array kNames{"seg.dcm", "rtstruct.dcm"};

void write_private(const fs::path& file, std::string_view bytes) {
    fs::create_directories(file.parent_path());
    fs::permissions(file.parent_path(), fs::perms::owner_all);
    write_file_atomically(file, bytes);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
}

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

/// A path or an address may have signs that no file's name has; this tells both apart from all others.
std::string file_name(const NamedArchive& named, const Session& session, const std::string& name) {
    Sha256 digest;
    const std::string whose = named.service.service + "\n" + fs::absolute(session.project_path()).string();
    digest.update(std::as_bytes(std::span(whose)));
    return fmt::format("{}_{}", digest.hex().substr(0, 32), name);
}

}  // namespace

fs::path ArchiveOutbox::folder() {
    const std::scoped_lock lock(mutex_);
    if (folder_.empty()) folder_ = temporary_.emplace().path() / "outbox";
    return folder_;
}

nlohmann::json ArchiveOutbox::send(const NamedArchive& named, Session& session, const Item& item, const StopToken& stop) {
    const fs::path file = folder() / file_name(named, session, item.name);
    std::error_code ignored;
    if (!item.is_again || !fs::exists(file, ignored)) {
        try {
            write_private(file, session.exported(item.name, std::nullopt, stop).bytes);
        } catch (const fs::filesystem_error& error) {
            throw Error(ErrorKind::io, fmt::format("{} cannot be kept in case it does not arrive: {}", file.string(),
                                                   error.code().message()));
        }
    }
    archive::Http http(named.service, named.access);
    const archive::Sent sent = archive::send_object(http, file, dicom_object(file), {.stop = stop});
    fs::remove(file, ignored);
    return answer(sent, named.service.host());
}

std::vector<std::string> ArchiveOutbox::waiting(const NamedArchive& named, const Session& session) const {
    std::vector<std::string> names;
    const std::scoped_lock lock(mutex_);
    if (folder_.empty()) return names;
    std::error_code ignored;
    for (const std::string name : kNames)
        if (fs::exists(folder_ / file_name(named, session, name), ignored)) names.push_back(name);
    return names;
}

}  // namespace kontur::viewer
