// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "archive/http.h"
#include "console.h"

// Addresses of an archive in place of paths.

namespace kontur::app {

/// How archives are reached.
struct ArchiveOptions {
    std::filesystem::path credentials, ca;  ///< files; empty: the environment's, the system's
    int give_up_s = archive::Access{}.give_up_s;
};

/// Throws what `read_credentials` throws, and Error(io) for a file of certificates that is not there.
archive::Access access_of(const ArchiveOptions& options);

/// Of a command, those words that may be addresses.
struct ArchiveWords {
    struct Place {
        std::filesystem::path* path;
        const std::optional<std::string>* series = nullptr;  ///< which one of a study; nullptr or nullopt: its only one
    };
    struct List {
        std::vector<std::filesystem::path>* paths;
        const std::optional<std::string>* series = nullptr;
    };
    ArchiveOptions options;
    std::vector<Place> places;
    std::vector<List> lists;
    bool is_for_page = false;    ///< the options are needed without addresses, too
    bool with_drawings = false;  ///< of a study the structure sets and segmentations come with the images
};

/// Fetches what addresses among the words name into the user's cache, says where, and puts the paths in their place. Throws
/// what `fetch_series` throws; Error(invalid_input) for options without an address that they are for, for the address of a
/// service, and for a study of several series of images, listing them.
void fetch_addresses(const ArchiveWords& words, Console& console);

}  // namespace kontur::app
