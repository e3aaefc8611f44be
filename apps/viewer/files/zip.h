// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace kontur::viewer {

struct ZipEntry {
    std::string name;  ///< ASCII
    std::string bytes;
};

/// An archive with these files, not compressed (PKWARE's APPNOTE 6.3.10), without times, so that the same files give the
/// same bytes. Throws Error(too_large) beyond 4 GiB or 65,535 files, where the format's first version ends.
std::string zip(const std::vector<ZipEntry>& entries);

}  // namespace kontur::viewer
