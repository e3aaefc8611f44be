// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>

#include "kontur/io/contours/contour_json.h"
#include "kontur/io/image.h"
#include "kontur/segment.h"
#include "support/coarse_grid.h"
#include "support/run_python.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kontur {
namespace {

constexpr double kOffset_mm = 1;

void write_grid(const std::filesystem::path& path, const Grid& grid) {
    std::ofstream out(path);
    out << std::setprecision(17) << grid.size.i << " " << grid.size.j << " " << grid.size.k << "\n";
    for (int row = 0; row < 3; ++row) {
        for (const double v : grid.index_to_mm.linear[row]) out << v << " ";
        out << grid.index_to_mm.translation[row] << "\n";
    }
}

std::vector<double> read_numbers(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istream_iterator<double>(in), {}};
}

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The method as printed, here and by an independent NumPy script: the same centres, weights and voxels.
void expect_numpy_agrees(const std::string& structure, const std::string& planes, std::int64_t coarsening) {
    const std::filesystem::path folder = test::data_dir() / "derived_nonparallel" / structure,
                                json = folder / (planes + ".json");
    const Grid grid = test::coarse(read_grid(folder / "truth.nii.gz"), coarsening);
    SegmentOptions options;
    options.kernel = Kernel::triharmonic;
    options.normals = Normals::in_plane;
    options.normal_offset_mm = kOffset_mm;
    options.smoothing = 0;
    options.solver = Solver::dense;
    options.voxelizer = Voxelizer::exhaustive;
    const Segmentation result = segment(read_contour_json(json), grid, options);

    const test::TemporaryFolder reference;
    write_grid(reference / "grid.txt", grid);
    const test::PythonResult python = test::run_python(
        "numpy_reference.py",
        {json.string(), (reference / "grid.txt").string(), std::to_string(kOffset_mm), reference.path().string()});
    ASSERT_EQ(python.exit_code, 0) << python.output;

    const std::vector<double> centers = read_numbers(reference / "centres.txt");
    const ImplicitFunction& function = result.function;
    ASSERT_EQ(centers.size(), 4 * function.weights().size());
    double largest = 0;
    for (const double w : function.weights()) largest = std::max(largest, std::abs(w));
    for (std::size_t i = 0; i < function.weights().size(); ++i) {
        const Vec3 there{centers[4 * i], centers[4 * i + 1], centers[4 * i + 2]};
        ASSERT_LT(distance(function.frame().center + function.frame().scale * function.centers()[i], there), 1e-9) << i;
        ASSERT_NEAR(function.weights()[i], centers[4 * i + 3], 1e-6 * largest) << i;
    }
    const std::vector<double> polynomial = read_numbers(reference / "polynomial.txt");
    ASSERT_EQ(polynomial.size(), 4u);
    for (std::size_t m = 0; m < 4; ++m) EXPECT_NEAR(function.polynomial()[m], polynomial[m], 1e-5 * std::abs(polynomial[0]));
    EXPECT_TRUE(read_bytes(reference / "mask.bin") == result.mask.values);
    EXPECT_GT(result.report.mask_voxels, 100);
}

TEST(PaperMethod, AgreesWithNumpyOnOrthogonalContoursOfAHippocampus) {
    KONTUR_REQUIRE_DATA("derived_nonparallel/hippocampus_label5/ortho3x3.json");
    expect_numpy_agrees("hippocampus_label5", "ortho3x3", 1);
}

TEST(PaperMethod, AgreesWithNumpyOnTiltedContoursOfAVertebralBody) {
    KONTUR_REQUIRE_DATA("derived_nonparallel/vertebral_body_L5label/tilted_parallel7.json");
    expect_numpy_agrees("vertebral_body_L5label", "tilted_parallel7", 4);
}

TEST(PaperMethod, AgreesWithNumpyOnRadialContoursOfTheLateralVentricles) {
    KONTUR_REQUIRE_DATA("derived_nonparallel/lateral_ventricles/radial6.json");
    expect_numpy_agrees("lateral_ventricles", "radial6", 3);
}

}  // namespace
}  // namespace kontur
