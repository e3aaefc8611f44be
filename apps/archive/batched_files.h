// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kontur::archive {

/// Files of a folder, one after the other, that get their names only once they are on the disk, the first one at once and
/// then many at a time: a flush for each would take longer than the network. Until then a file is hidden ("." in front),
/// which a killed process leaves behind and the next one overwrites. All members throw Error(io) naming the file and the
/// system's reason.
class BatchedFiles {
public:
    explicit BatchedFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// A file that is not ended is removed, and so are those without names.
    ~BatchedFiles();
    BatchedFiles(const BatchedFiles&) = delete;
    BatchedFiles& operator=(const BatchedFiles&) = delete;

    void begin(const std::string& name);
    void write(std::string_view bytes);
    void end();
    /// Whatever was ended is on the disk, under its name.
    void flush();
    /// To be called while nothing comes, too: flushes what has waited long enough.
    void wait();

private:
    struct File {
        std::string name;
        int descriptor;
    };
    std::filesystem::path hidden(const File& file) const { return folder_ / ("." + file.name); }
    [[noreturn]] void fail(const File& file, int reason) const;
    void give_up(const File& file) const;
    bool is_awaited() const;

    std::filesystem::path folder_;
    std::vector<File> ended_;
    std::vector<File> open_;   ///< one, or none
    std::uint64_t bytes_ = 0;  ///< written since the last flush
    std::chrono::steady_clock::time_point flushed_{};
};

}  // namespace kontur::archive
