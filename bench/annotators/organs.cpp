// SPDX-License-Identifier: Apache-2.0
// How sure kontur is of real structures, and what is true: a line of JSON for each drawing, without and with its image.
// bench/annotators/organ_band.py calls it for every structure and makes the tables.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "drawn_structures.h"
#include "kontur/base/error.h"
#include "kontur/base/point_tree.h"
#include "kontur/evidence.h"
#include "kontur/measure/compare.h"
#include "kontur/segment.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "true_border.h"

namespace kontur {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kSamples = 240;

/// The border that the judged structure has.
struct TrueBorder {
    BorderPoints middles;
    PointTree of_faces, of_level;

    explicit TrueBorder(const Mask& mask)
        : middles(points_on_faces(mask, 1)), of_faces(points_on_faces(mask, 4).points), of_level(points_on_level(mask)) {}
};

/// Every so many samples of the surface: distance to the lines, slope, distances from the true level and from the voxels'
/// border, share of the area, share that the image leaves. Lengths in sizes of the surface.
ordered_json sample_rows(const SurfaceEvidence& e, const TrueBorder& truth) {
    ordered_json rows = ordered_json::array();
    const std::size_t step = e.samples.points.size() / kSamples + 1;
    const double size = e.size_mm;
    for (std::size_t n = step / 2; n < e.samples.points.size(); n += step) {
        const Vec3& p = e.samples.points[n];
        rows.push_back({rounded(e.distances_mm[n] / size, 1e-5), rounded(e.samples.slopes[n], 1e-3),
                        rounded(truth.of_level.distance_to(p) / size, 1e-5),
                        rounded(e.samples.areas_mm2[n] / e.samples.area_mm2(), 1e-6), rounded(e.shares[n], 1e-3),
                        rounded(truth.of_faces.distance_to(p) / size, 1e-5)});
    }
    return rows;
}

void measure(const Structure& structure, const TrueBorder& truth, const WantedDrawing& wanted, UseImage use) {
    const ContourSet contours = drawn(structure, wanted);
    const Segmentation made =
        segment(contours, structure.truth.grid, &structure.image, {.use_image = use, .mesh = true}, kAlone);
    const SurfaceEvidence e = gather_evidence(made, contours, kAlone);
    const SurfaceUncertainty& u = made.report.uncertainty;
    if (!u.is_known) return;
    double true_mm3 = 0;
    for (const auto value : structure.truth.values) true_mm3 += value ? structure.truth.grid.voxel_volume_mm3() : 0;
    const Vec3 spacing = structure.truth.grid.spacing_mm();
    const ImageReport& image = made.report.image;
    ordered_json line{{"structure", structure.name},
                      {"kind", wanted.kind},
                      {"planes", wanted.count},
                      {"hand", wanted.by_hand ? "hand" : "exact"},
                      {"use", use == UseImage::off ? "off" : "auto"},
                      {"way", wanted.kind},
                      {"verdict", name(image.verdict)},
                      {"walked", image.walked},
                      {"error_without_mm", image.error_without_mm},
                      {"error_with_mm", image.error_with_mm},
                      {"wrong_without", image.wrong_without},
                      {"wrong_with", image.wrong_with},
                      {"different_planes", e.plane_count()},
                      {"whole_planes", e.whole_planes()},
                      {"dice", compare(made.mask, structure.truth, {1}).dice},
                      {"expected", u.dice.value},
                      {"low", u.dice.low},
                      {"high", u.dice.high},
                      {"volume_low_ml", u.volume_low_ml},
                      {"volume_high_ml", u.volume_high_ml},
                      {"size_mm", e.size_mm},
                      {"area_mm2", e.samples.area_mm2()},
                      {"volume_mm3", e.volume_mm3},
                      {"true_volume_mm3", true_mm3},
                      {"voxel_mm", e.voxel_mm},
                      {"spacing_mm", {spacing.x, spacing.y, spacing.z}},
                      {"residual_mm", e.residual_mm},
                      {"disagreement_mm", e.disagreement_mm},
                      {"hand_mm", e.hand_mm}};
    line["samples"] = sample_rows(e, truth);
    line["border"] = border_rows(e, *made.mesh, truth.middles);
    fmt::print("{}\n", line.dump());
    std::fflush(stdout);
}

void run(const std::vector<std::string>& words) {
    const Structure structure = read_structure(words);
    const TrueBorder truth(structure.truth);
    const char* with_image = std::getenv("KONTUR_ORGANS_IMAGE");
    for (const WantedDrawing& wanted : wanted_drawings()) try {
            measure(structure, truth, wanted, with_image ? UseImage::automatic : UseImage::off);
        } catch (const Error& error) {
            fmt::print(stderr, "{} {}: {}\n", structure.name, wanted.name(), error.what());
        }
}

}  // namespace
}  // namespace kontur

int main(int count, char** words) {
    try {
        kontur::run({words + 1, words + count});
    } catch (const std::exception& error) {
        fmt::print(stderr, "kontur_organs: error: {}\n", error.what());
        return 1;
    }
}
