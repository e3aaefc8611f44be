// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/shape/volume.h"
#include "support/paths.h"

namespace kontur::test {

/// Grids of 4 x 3 x 2 voxels in all 48 orientations along the patient axes (24 of them left-handed), and oblique, sheared
/// and mirrored ones. Spacing and origin are anisotropic and far from 0.
inline std::vector<Grid> all_orientations() {
    const Vec3 spacing{0.7, 1.3, 2.5}, origin{-123.4, 56.7, -1890.1};
    std::vector<Grid> grids;
    const auto add = [&](const Vec3& i, const Vec3& j, const Vec3& k) {
        Grid grid{{4, 3, 2}, {}};
        grid.index_to_mm.set_column(0, spacing.x * i);
        grid.index_to_mm.set_column(1, spacing.y * j);
        grid.index_to_mm.set_column(2, spacing.z * k);
        grid.index_to_mm.translation = origin;
        grids.push_back(grid);
    };
    constexpr int kPermutations[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& permutation : kPermutations)
        for (int signs = 0; signs < 8; ++signs) {
            Vec3 axes[3];
            for (int n = 0; n < 3; ++n) axes[n][permutation[n]] = signs >> n & 1 ? -1 : 1;
            add(axes[0], axes[1], axes[2]);
        }
    for (const double angle : {0.3, 1.4, 2.9, 3.1414}) {
        const Vec3 i = normalized({std::cos(angle), std::sin(angle), 0.4});
        const Vec3 j = any_perpendicular(i);
        add(i, j, cross(i, j));
        add(i, j, -cross(i, j));
        // Gantry tilt: slices shifted along j.
        add(i, j, normalized(cross(i, j) + 0.33 * j));
    }
    return grids;
}

/// Values that differ between neighbours along each axis; integers wrap around at the end of their type.
template <typename Value>
Image pattern_image(const Grid& grid) {
    std::vector<Value> values;
    for (std::int64_t n = 0; n < grid.voxel_count(); ++n) {
        if constexpr (std::is_floating_point_v<Value>)
            values.push_back(static_cast<Value>(0.37 * static_cast<double>(n * n) - 20));
        else values.push_back(static_cast<Value>(std::is_signed_v<Value> ? n * 997 - 9000 : n * 10));
    }
    return {grid, values};
}

inline void expect_same_values(const Image& a, const Image& b, const std::string& context) {
    ASSERT_EQ(a.grid.size, b.grid.size) << context;
    for (std::size_t n = 0; n < static_cast<std::size_t>(a.grid.voxel_count()); ++n)
        ASSERT_EQ(sample(a, n), sample(b, n)) << context << ", voxel " << n;
}

inline std::string content_of(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

inline void put_content(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

inline Error error_of(const std::function<void()>& action, const std::string& context) {
    try {
        action();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << context << ": no Error";
    return Error(ErrorKind::cancelled, "");
}

inline void expect_error(ErrorKind kind, const std::string& part, const std::function<void()>& action) {
    const Error error = error_of(action, part);
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
}

/// Every proper prefix of the file must be refused as corrupt, in one sentence, whatever reads it.
inline void expect_prefixes_refused(const std::filesystem::path& whole, const std::filesystem::path& part,
                                    const std::function<void(const std::filesystem::path&)>& read) {
    const std::string bytes = content_of(whole);
    ASSERT_NO_THROW(read(whole));
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        put_content(part, bytes.substr(0, length));
        const Error error = error_of([&] { read(part); }, std::to_string(length) + " bytes");
        ASSERT_EQ(error.kind(), ErrorKind::corrupt_file) << length << " of " << bytes.size() << ": " << error.what();
    }
}

/// No flipped bit may do more than make the reader throw an Error: no crash, no huge allocation, no other exception.
inline void expect_flips_survived(const std::filesystem::path& whole, const std::filesystem::path& spoiled,
                                  const std::function<void(const std::filesystem::path&)>& read) {
    std::string bytes = content_of(whole);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        const auto flip = static_cast<char>(1 << bit % 8);
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
        put_content(spoiled, bytes);
        try {
            read(spoiled);
        } catch (const Error& error) {
            ASSERT_FALSE(std::string(error.what()).empty());
        }
        bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ flip);
    }
}

/// What an independent reader must find in `image_path`, beside it: size, index to mm (LPS) by rows, tolerance in mm,
/// voxels.
inline void write_expectation(const std::filesystem::path& image_path, const Image& image, double tolerance_mm) {
    std::ofstream out(image_path.string() + ".expect");
    out.precision(17);
    out << image.grid.size.i << ' ' << image.grid.size.j << ' ' << image.grid.size.k << '\n';
    for (int row = 0; row < 3; ++row)
        out << image.grid.index_to_mm.linear[row][0] << ' ' << image.grid.index_to_mm.linear[row][1] << ' '
            << image.grid.index_to_mm.linear[row][2] << ' ' << image.grid.index_to_mm.translation[row] << '\n';
    out << tolerance_mm << '\n';
    for (std::size_t n = 0; n < static_cast<std::size_t>(image.grid.voxel_count()); ++n) out << sample(image, n) << '\n';
}

struct Expectation {
    Image image;
    double tolerance_mm = 0;
};

/// The reverse, for files that an independent writer made. The samples are floats.
inline Expectation read_expectation(const std::filesystem::path& image_path) {
    std::ifstream in(image_path.string() + ".expect");
    Expectation expected;
    Grid& grid = expected.image.grid;
    in >> grid.size.i >> grid.size.j >> grid.size.k;
    for (int row = 0; row < 3; ++row) {
        for (double& value : grid.index_to_mm.linear[row]) in >> value;
        in >> grid.index_to_mm.translation[row];
    }
    in >> expected.tolerance_mm;
    std::vector<float> values;
    for (double value; in >> value;) values.push_back(static_cast<float>(value));
    expected.image.samples = values;
    return expected;
}

/// Reads every file in the folder that has an expectation beside it and compares grid and voxels; returns how many. Where
/// `read_grid` is given, it has to give the same grid.
inline int compare_with_expectations(const std::filesystem::path& folder,
                                     const std::function<Image(const std::filesystem::path&)>& read,
                                     const std::function<Grid(const std::filesystem::path&)>& read_grid = {}) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::filesystem::path& path = entry.path();
        if (!std::filesystem::exists(path.string() + ".expect")) continue;
        SCOPED_TRACE(path.string());
        const Expectation expected = read_expectation(path);
        const Image image = read(path);
        EXPECT_LE(corner_distance_mm(image.grid, expected.image.grid), expected.tolerance_mm);
        if (read_grid) {
            EXPECT_EQ(read_grid(path), image.grid);
        }
        expect_same_values(image, expected.image, path.string());
        ++files;
    }
    return files;
}

/// Runs tests/support/image_oracle.py, an independent reader and writer; its complaints are the message.
inline void run_image_oracle(const std::string& command, const std::filesystem::path& folder) {
    const std::filesystem::path log = folder / "oracle.log";
    const std::string line = "\"" + python_program() + "\" \"" + support_folder() + "/image_oracle.py\" " + command + " \"" +
                             folder.string() + "\" > \"" + log.string() + "\" 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0) << content_of(log);
    std::filesystem::remove(log);
}

}  // namespace kontur::test
