// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kontur::viewer {

/// What has come of a series that is on its way. Safe for concurrent use.
class ArrivingSlices {
public:
    /// `folders`: where the series may lie, of which the first that is there counts.
    explicit ArrivingSlices(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

    /// The slice that lies nearest to `at_mm` along its normal or, without, that came last, as a binary reply: `width`,
    /// `height` (at most 384), `slices` (so many are here), `at_mm`, `first_mm`, `last_mm`, and the array `pixels`. ""
    /// before the first one. Throws as `read_dicom_slice`.
    std::string picture(std::optional<double> at_mm);

private:
    struct Slice {
        std::string file;
        std::int64_t frame;
        double at_mm;
    };
    std::optional<std::filesystem::path> folder() const;
    void look_into(const std::filesystem::path& folder);
    void add(const std::filesystem::path& file);
    std::string picture_in(const std::filesystem::path& folder, std::optional<double> at_mm);

    const std::vector<std::filesystem::path> folders_;
    std::mutex mutex_;             ///< of what follows
    std::set<std::string> known_;  ///< names of files
    std::vector<Slice> slices_;    ///< in the order in which they came
};

}  // namespace kontur::viewer
