// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kontur/base/stop.h"
#include "viewer/model/temporary_files.h"
#include "viewer/server/named_archive.h"
#include "viewer/session/session.h"

namespace kontur::viewer {

/// What was made on an image, on its way into the archive that the image came from. What did not arrive is kept as it is in
/// a folder that nobody else may look into, so that it is the same object when it is sent again, also by the next kontur.
/// Safe for concurrent use.
class ArchiveOutbox {
public:
    struct Item {
        std::string name;       ///< of an export, "seg.dcm" or "rtstruct.dcm"
        bool is_again = false;  ///< the one that did not arrive last time, if there is one
    };

    /// An empty path: it is kept until kontur ends.
    explicit ArchiveOutbox(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    /// `outcome` and a sentence as `text`: what the archive answers. Throws what the export and `send_object` throw, and
    /// Error(io) where nothing can be kept.
    nlohmann::json send(const NamedArchive& named, Session& session, const Item& item, const StopToken& stop);

    /// Names of what was made in the session's project and did not arrive in this archive.
    std::vector<std::string> waiting(const NamedArchive& named, const Session& session) const;

private:
    std::filesystem::path folder();

    mutable std::mutex mutex_;  ///< of what follows
    std::optional<TemporaryFolder> temporary_;
    std::filesystem::path folder_;  ///< empty: there is none yet
};

}  // namespace kontur::viewer
