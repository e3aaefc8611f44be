// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kontur::viewer {

/// How the page was arranged last for images of each modality: which panes are shown, and how large. Their meaning is the
/// page's. In a file beside the list of recent projects. Safe for concurrent use in one process; of two that write at a time
/// the later one's stay.
class Arrangements {
public:
    /// An empty path: nothing is kept.
    explicit Arrangements(std::filesystem::path file = {});

    /// Null where none is known, or the file cannot be read. "" is a modality, too: that of images that name none.
    nlohmann::json of(const std::string& modality) const;
    /// Best effort: a file that cannot be written keeps nobody from work. Throws Error(too_large) where `state` has more
    /// than 4 KiB, Error(invalid_input) where the modality is no code string of DICOM.
    void keep(const std::string& modality, const nlohmann::json& state);

private:
    nlohmann::json stored() const;

    std::filesystem::path file_;
    mutable std::mutex mutex_;
};

}  // namespace kontur::viewer
