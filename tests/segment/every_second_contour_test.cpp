// SPDX-License-Identifier: Apache-2.0
// Real drawings with half of their slices left out: what the fit puts between them must be what the physician drew there.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/segment.h"
#include "support/test_data.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// Contours of parallel planes, slice by slice, in the order of the planes.
std::vector<std::vector<Contour>> slices(const ContourSet& set) {
    const Plane& first = set.contours.front().plane;
    std::vector<Contour> sorted = set.contours;
    const auto height = [&](const Contour& contour) { return first.distance_to(contour.plane.origin); };
    std::ranges::stable_sort(sorted, {}, height);
    std::vector<std::vector<Contour>> slices;
    double last = 0;
    for (const Contour& contour : sorted) {
        if (slices.empty() || height(contour) > last + 0.5) slices.emplace_back();
        slices.back().push_back(contour);
        last = height(contour);
    }
    return slices;
}

/// Every second slice with all its contours, and always the last one.
ContourSet every_second_slice(const ContourSet& set) {
    const auto drawn = slices(set);
    ContourSet kept;
    for (std::size_t s = 0; s < drawn.size(); ++s)
        if (s % 2 == 0 || s + 1 == drawn.size()) kept.contours.insert(kept.contours.end(), drawn[s].begin(), drawn[s].end());
    return kept;
}

/// The mask's slices from the first to the last one that is not empty: what was drawn, without what lies beyond.
Mask between_first_and_last(const Mask& mask, const Mask& drawn) {
    const std::int64_t plane = mask.grid.size.i * mask.grid.size.j;
    const auto empty = [&](std::int64_t k) {
        const auto begin = drawn.values.begin() + k * plane;
        return std::all_of(begin, begin + plane, [](std::uint8_t v) { return v == 0; });
    };
    std::int64_t low = 0, high = mask.grid.size.k;
    while (empty(low)) ++low;
    while (empty(high - 1)) --high;
    Mask part = mask;
    std::fill(part.values.begin(), part.values.begin() + low * plane, std::uint8_t{0});
    std::fill(part.values.begin() + high * plane, part.values.end(), std::uint8_t{0});
    return part;
}

/// Lower bounds of Dice against the mask of all contours, a little below what was measured.
struct Floor {
    double whole;    ///< all slices: the contours do not say where between two slices the object ends
    double between;  ///< slices from the first to the last drawn one
};

void expect_agreement(const ContourSet& drawn, const Mask& truth, const Floor& floor, double quality = 1) {
    const ContourSet kept = every_second_slice(drawn);
    ASSERT_LT(kept.contours.size(), drawn.contours.size() * 3 / 4);
    SegmentOptions options;
    options.quality = quality;
    const Mask mask = segment(kept, truth.grid, options).mask;
    const Comparison whole = compare(mask, truth);
    const Comparison between = compare(between_first_and_last(mask, truth), truth);
    std::cout << "measured: Dice " << whole.dice << ", from the first to the last slice " << between.dice << "\n";
    EXPECT_GE(whole.dice, floor.whole) << "mask " << whole.volume_a_ml << " ml, truth " << whole.volume_b_ml << " ml";
    EXPECT_GE(between.dice, floor.between);
}

struct Sarcoma {
    const char* folder;
    const char* mask;
    Floor floor;
    double quality = 1;  ///< less where the file has 16,000 points, to be done in seconds
    friend std::ostream& operator<<(std::ostream& out, const Sarcoma& s) { return out << s.folder; }
};

class EverySecondContour : public testing::TestWithParam<Sarcoma> {};

TEST_P(EverySecondContour, OfASarcomaGivesTheWholeTumour) {
    KONTUR_REQUIRE_DATA(GetParam().folder);
    const fs::path folder = test::data_dir() / GetParam().folder;
    const Mask truth = read_mask(folder / GetParam().mask);
    const Grid grid = read_dicom_grid(folder / "image").grid;
    ASSERT_LT(corner_distance_mm(grid, truth.grid), 0.1);
    const Roi roi = select_roi(read_rtstruct(folder / "RTSTRUCT_RS.dcm"));
    expect_agreement(roi.contours, {grid, truth.values}, GetParam().floor, GetParam().quality);
}

INSTANTIATE_TEST_SUITE_P(Sarcomas, EverySecondContour,
                         testing::Values(Sarcoma{"03_sarcoma_STS_002/CT", "CT_mask.nii.gz", {0.985, 0.985}},
                                         Sarcoma{"03_sarcoma_STS_002/MR_T1", "MR_T1_mask.nii.gz", {0.985, 0.985}},
                                         Sarcoma{"03_sarcoma_STS_002/PET", "PET_mask.nii.gz", {0.98, 0.98}},
                                         Sarcoma{"04_sarcoma_STS_040/CT", "CT_mask.nii.gz", {0.97, 0.97}, 0.25},
                                         Sarcoma{"05_sarcoma_STS_008/CT", "CT_mask.nii.gz", {0.975, 0.975}},
                                         Sarcoma{"05_sarcoma_STS_008/MR_T1", "MR_T1_mask.nii.gz", {0.975, 0.975}}));

struct Ventricle {
    const char* name;
    const char* kind;  ///< endocardium or epicardium
    int phase;
    const char* mask;
    Floor floor;
    friend std::ostream& operator<<(std::ostream& out, const Ventricle& v) { return out << v.name; }
};

/// One heart phase's contours of one wall, from the data set's own list of contours in LPS mm.
ContourSet cardiac_contours(const fs::path& path, const Ventricle& ventricle) {
    std::ifstream file(path);
    const auto json = nlohmann::json::parse(file);
    ContourSet set;
    for (const auto& entry : json.at("contours")) {
        if (entry.at("kind") != ventricle.kind || entry.at("phase") != ventricle.phase) continue;
        Contour contour;
        for (const auto& p : entry.at("points")) contour.points.push_back({p.at(0), p.at(1), p.at(2)});
        set.contours.push_back(contour);
    }
    drop_duplicate_points(set);
    // All slices are parallel; a plane fitted to each contour would differ in the normal's sign and last digits.
    const Vec3 normal = fit_plane(set.contours.front().points).value().normal;
    for (Contour& contour : set.contours) contour.plane = make_plane(contour.points.front(), normal);
    return set;
}

class EverySecondShortAxis : public testing::TestWithParam<Ventricle> {};

TEST_P(EverySecondShortAxis, OfALeftVentricleGivesTheWholeVentricle) {
    KONTUR_REQUIRE_DATA("10_cine_mr_SC-HF-I-1/contours_lps.json");
    const fs::path folder = test::data_dir() / "10_cine_mr_SC-HF-I-1";
    const Mask truth = read_mask(folder / GetParam().mask);
    ASSERT_LT(truth.grid.index_to_mm.determinant(), 0) << "this image is left-handed";
    expect_agreement(cardiac_contours(folder / "contours_lps.json", GetParam()), truth, GetParam().floor);
}

INSTANTIATE_TEST_SUITE_P(CineMr, EverySecondShortAxis,
                         testing::Values(Ventricle{"ED_endo", "endo", 18, "mask_ED_endo.nii.gz", {0.91, 0.945}},
                                         Ventricle{"ES_endo", "endo", 7, "mask_ES_endo.nii.gz", {0.915, 0.935}},
                                         Ventricle{"ED_epi", "epi", 18, "mask_ED_epi.nii.gz", {0.915, 0.955}}));

}  // namespace
}  // namespace kontur
