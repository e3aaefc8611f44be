// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/dicom/dicom_series.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"

namespace kontur::test {

/// What a generated series truly shows.
struct Truth {
    Grid grid;
    std::vector<double> values;
};

inline Truth read_truth(const std::filesystem::path& folder) {
    Truth truth;
    std::ifstream text(folder / "truth.txt");
    text >> truth.grid.size.i >> truth.grid.size.j >> truth.grid.size.k;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) text >> truth.grid.index_to_mm.linear[row][column];
        text >> truth.grid.index_to_mm.translation[row];
    }
    truth.values.resize(static_cast<std::size_t>(truth.grid.voxel_count()));
    std::ifstream raw(folder / "truth.raw", std::ios::binary);
    raw.read(reinterpret_cast<char*>(truth.values.data()), static_cast<std::streamsize>(8 * truth.values.size()));
    if (!text || !raw) throw std::runtime_error("no truth in " + folder.string());
    return truth;
}

class DicomSeriesTest : public testing::Test {
protected:
    /// Generates a case and returns the folder with its files.
    std::filesystem::path make(const std::string& name, const std::string& script = "make_dicom_series.py") {
        const auto made = run_python(script, {name, (folder_ / name).string()});
        if (made.exit_code != 0) throw std::runtime_error(made.output);
        return folder_ / name / "dicom";
    }

    DicomVolume read_and_check(const std::string& name, const DicomSeriesOptions& options = {}) {
        make(name);
        return check(name, options);
    }

    /// Reads and compares every voxel and the corners of the grid with the truth.
    DicomVolume check(const std::string& name, const DicomSeriesOptions& options = {}) {
        const std::filesystem::path files = folder_ / name / "dicom";
        const Truth truth = read_truth(folder_ / name);
        DicomVolume volume = read_dicom_series(files, options);
        EXPECT_LT(corner_distance_mm(volume.image.grid, truth.grid), 1e-5);
        EXPECT_EQ(read_dicom_grid(files, options).grid, volume.image.grid);
        double worst = 0;
        for (std::size_t n = 0; n < truth.values.size(); ++n)
            worst = std::max(worst, std::abs(sample(volume.image, n) - truth.values[n]));
        EXPECT_LT(worst, 1e-3);
        return volume;
    }

    Error refusal(const std::filesystem::path& path, const DicomSeriesOptions& options = {}) {
        try {
            read_dicom_series(path, options);
        } catch (const Error& error) {
            return error;
        }
        ADD_FAILURE() << "accepted: " << path;
        return Error(ErrorKind::io, "");
    }

    TemporaryFolder folder_;
};

#define EXPECT_REFUSED(error_expression, expected_kind, part)                                              \
    do {                                                                                                   \
        const Error refused = (error_expression);                                                          \
        EXPECT_EQ(kontur::name(refused.kind()), kontur::name(ErrorKind::expected_kind)) << refused.what(); \
        EXPECT_NE(std::string_view(refused.what()).find(part), std::string_view::npos) << refused.what();  \
    } while (false)

inline bool notes_mention(const std::vector<std::string>& notes, std::string_view part) {
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

template <typename T>
bool has_samples(const DicomVolume& volume) {
    return std::holds_alternative<std::vector<T>>(volume.image.samples);
}

}  // namespace kontur::test
