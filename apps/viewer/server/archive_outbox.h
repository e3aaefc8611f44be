// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "kontur/base/stop.h"
#include "viewer/server/named_archive.h"
#include "viewer/session/session.h"

namespace kontur::viewer {

/// What was made on an image, on its way into the archive that the image came from. What did not arrive is kept as it is
/// until kontur ends, so that it is the same object when it is sent again. Safe for concurrent use.
class ArchiveOutbox {
public:
    struct Item {
        std::string name;       ///< of an export, "seg.dcm" or "rtstruct.dcm"
        bool is_again = false;  ///< the one that did not arrive last time, if there is one
    };

    /// `outcome` and a sentence as `text`: what the archive answers. Throws what the export and `send_object` throw.
    nlohmann::json send(const NamedArchive& named, Session& session, const Item& item, const StopToken& stop);

private:
    std::string bytes_of(Session& session, const Item& item, const StopToken& stop);

    std::mutex mutex_;
    std::map<std::string, std::string> kept_;  ///< bytes by project and name
};

}  // namespace kontur::viewer
