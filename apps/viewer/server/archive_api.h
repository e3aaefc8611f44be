// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kontur/base/stop.h"
#include "viewer/server/access.h"
#include "viewer/server/start_api.h"

namespace kontur::viewer {

/// GET requests below /api/archive/ (docs/viewer-protocol.md): `studies` by name, id, date and modality; `series` of a
/// study; `picture`, a JPEG of the middle slice of a series. nullopt for other addresses. Throws what the archive's client
/// throws.
std::optional<StartReply> archive_api(const NamedArchive& named, const Target& target, const StopToken& stop);

/// Throws Error(invalid_input), with the name of what it is, for what is none.
std::string checked_uid(std::string uid, std::string_view name);

}  // namespace kontur::viewer
