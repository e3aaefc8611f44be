// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "fuzz/scratch_folder.h"
#include "kontur/base/error.h"
#include "viewer/session/session.h"

namespace kontur::fuzz {
namespace {

/// A ramp with an edge in it, for the live-wire.
std::shared_ptr<const Image> small_image() {
    static const auto image = [] {
        std::vector<std::int16_t> samples(12 * 12 * 12);
        for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<std::int16_t>(n % 12 > 5 ? 500 : n);
        return std::make_shared<const Image>(Image{{{12, 12, 12}, {}}, samples});
    }();
    return image;
}

viewer::ImageReference reference() { return {"phantom", "12x12x12-int16-0123456789abcdef"}; }

void remove_project(const std::filesystem::path& path) {
    for (const char* more : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(path.string() + more);
}

}  // namespace

/// The lines of a page's WebSocket, in order.
void messages(Bytes bytes) {
    constexpr int kMostMessages = 16;
    const auto path = scratch().path() / "messages.kontur";
    remove_project(path);
    viewer::Session session({small_image(), "ramp", reference(), {}}, path);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (int n = 0; n < kMostMessages && !text.empty(); ++n) {
        const std::string_view line = text.substr(0, text.find('\n'));
        session.call(line);
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
}

/// The rows of a project file from elsewhere, one a line: structures, contours, steps of the history and settings in turn.
/// SQLite's own reading of damaged files is left to those who fuzz SQLite.
void project(Bytes bytes) {
    const auto path = scratch().path() / "rows.kontur";
    remove_project(path);
    {
        viewer::Project project(path, reference());
        viewer::Database& database = project.database();
        std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        for (std::int64_t n = 0; !text.empty() && n < 12; ++n) {
            const std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            const char* table = n % 4 == 0   ? "INSERT INTO structure VALUES (?1, ?2)"
                                : n % 4 == 1 ? "INSERT INTO contour VALUES (?1, ?2)"
                                : n % 4 == 2 ? "INSERT INTO history VALUES (?1, 'step', 'now', ?2)"
                                             : "UPDATE setting SET value = ?2 WHERE key = 'position' AND ?1";
            viewer::Query(database, table).bind(n / 4 + 1).bind(line).finish();
        }
    }
    viewer::Project project(path, reference());
    for (int n = 0; n < 5 && project.undo(); ++n) continue;
    for (int n = 0; n < 5 && project.redo(); ++n) continue;
    project.page_state();
}

}  // namespace kontur::fuzz
