// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "archive/http.h"
#include "kontur/base/stop.h"
#include "viewer/server/access.h"

namespace kontur::viewer {

/// The archive that the command named: the only one that pages reach, and that without its address or its password.
struct NamedArchive {
    archive::Address service;
    archive::Access access;
};

/// What a page sees of it.
struct ArchiveReply {
    std::string content_type;
    std::string body;
};

/// GET requests below /api/archive/ (docs/viewer-protocol.md): `studies` by name, id, date and modality; `series` of a
/// study; `picture`, a JPEG of the middle slice of a series. nullopt for other addresses. Throws what the archive's client
/// throws.
std::optional<ArchiveReply> archive_api(const NamedArchive& named, const Target& target, const StopToken& stop);

}  // namespace kontur::viewer
