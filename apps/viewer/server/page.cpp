// SPDX-License-Identifier: Apache-2.0
#include "viewer/server/page.h"

#include <vector>

#include "viewer/server/page_table.h"

namespace kontur::viewer {
namespace {

std::vector<PageFile> embedded_files() {
    std::vector<PageFile> files;
    for (std::size_t i = 0; i < kPageEntryCount; ++i) {
        const PageEntry& entry = kPageEntries[i];
        files.push_back({entry.path, entry.content_type, {kontur_page_blob + entry.offset, entry.size}});
    }
    return files;
}

}  // namespace

const PageFile* find_page_file(std::string_view path) {
    static const std::vector<PageFile> files = embedded_files();
    for (const PageFile& file : files)
        if (file.path == path) return &file;
    return nullptr;
}

bool has_page() { return kPageEntryCount > 1; }

}  // namespace kontur::viewer
