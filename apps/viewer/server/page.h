// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kontur::viewer {

/// A file of the page, embedded in the program.
struct PageFile {
    std::string_view path;  ///< "/index.html"
    std::string_view content_type;
    std::string_view gzip;
};

/// null when the page has no such file.
const PageFile* find_page_file(std::string_view path);

/// Whether the page itself is embedded, not only the file that says why it is missing.
bool has_page();

}  // namespace kontur::viewer
