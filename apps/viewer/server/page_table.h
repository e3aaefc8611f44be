// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

// What embed_page.py writes: where the page's files lie in `kontur_page_blob`.

extern "C" const char kontur_page_blob[];

namespace kontur::viewer {

struct PageEntry {
    const char* path;
    const char* content_type;
    std::size_t offset, size;
};
extern const PageEntry kPageEntries[];
extern const std::size_t kPageEntryCount;

}  // namespace kontur::viewer
