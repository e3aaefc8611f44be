// SPDX-License-Identifier: Apache-2.0
// How well masks made from a few contours agree with the truth: kontur's defaults, the paper's method as printed and, where
// the true surface is known, a fit with the true tilts. docs/accuracy/drawings.md is made of the output.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/contours.h"
#include "kontur/io/image.h"
#include "kontur/measure/compare.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/phantom.h"
#include "kontur/pipeline.h"
#include "kontur/segment.h"
#include "true_tilts.h"

namespace kontur {
namespace {

namespace fs = std::filesystem;

/// The paper's method: in-plane normals of 1 mm, exact interpolation.
SegmentOptions as_printed() {
    SegmentOptions options;
    options.kernel = Kernel::triharmonic;
    options.normals = Normals::in_plane;
    options.normal_offset_mm = 1;
    options.solver = Solver::cholesky;
    return options;
}

/// The same field of view with voxels of twice the size.
Grid coarsened(const Grid& grid) {
    Grid coarse = grid;
    for (int axis = 0; axis < 3; ++axis) {
        coarse.size[axis] = (grid.size[axis] + 1) / 2;
        coarse.index_to_mm.set_column(axis, 2.0 * grid.index_to_mm.column(axis));
    }
    coarse.index_to_mm.translation += 0.5 * grid.index_to_mm.apply_linear({1, 1, 1});
    return coarse;
}

/// One drawing of one object, segmented in each way.
struct Row {
    std::string object;
    std::string drawing;
    std::size_t contours = 0;
    std::size_t points = 0;
    ImplicitFunction function;  ///< of kontur's fit
    Comparison kontur;
    std::optional<Comparison> paper;
    std::optional<Comparison> true_tilts;            ///< of the fit with the true tilts
    std::optional<double> normal_error_degrees;      ///< of kontur's fit
    std::optional<NormalErrors> normals;             ///< of kontur's fit, where the truth is a mask
    std::optional<NormalErrors> true_tilts_normals;  ///< of the fit with the true tilts
};

Row segment_both_ways(const ContourSet& contours, const Mask& truth, bool with_paper) {
    Row row;
    row.contours = contours.contours.size();
    row.points = point_count(contours);
    const Segmentation by_default = segment(contours, truth.grid, {.drawn_on = truth.grid});
    row.kontur = compare(by_default.mask, truth);
    row.function = by_default.function;
    if (with_paper) row.paper = compare(segment(contours, truth.grid, as_printed()).mask, truth);
    return row;
}

std::vector<Vec3> drawn_points(const ContourSet& set) {
    std::vector<Vec3> points;
    for (const Contour& contour : set.contours) points.insert(points.end(), contour.points.begin(), contour.points.end());
    return points;
}

/// Mean angle between the fitted and the true normals at the drawn points.
double normal_error_degrees(const PhantomCase& drawn, const ImplicitFunction& function) {
    const std::vector<Vec3> points = drawn_points(drawn.contours);
    std::vector<Vec3> gradients(points.size());
    function.gradients(points, gradients);
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += std::acos(std::clamp(-dot(normalized(gradients[i]), drawn.body->outward_normal(points[i])), -1.0, 1.0));
    return sum / static_cast<double>(points.size()) * 180 / std::numbers::pi;
}

/// The phantom's cases whose true body is known. Half the liver's resolution tells the same at an eighth of the time.
std::vector<Row> phantom_rows(bool with_paper) {
    std::vector<Row> rows;
    for (const std::string& name : phantom_case_names()) {
        const PhantomCase drawn = phantom_case(name);
        if (!drawn.body) continue;
        fmt::print(stderr, "phantom {}\n", name);
        const Grid grid = drawn.body->name() == "liver" ? coarsened(drawn.grid) : drawn.grid;
        const Mask truth = make_truth_mask(*drawn.body, grid);
        Row row = segment_both_ways(drawn.contours, truth, with_paper);
        const NormalAt normal = [&](const Vec3& p) { return drawn.body->outward_normal(p); };
        row.true_tilts = compare(segment_with_true_tilts(drawn.contours, grid, normal).mask, truth);
        row.normal_error_degrees = normal_error_degrees(drawn, row.function);
        row.object = "phantom";
        row.drawing = name;
        rows.push_back(row);
    }
    return rows;
}

/// What the tilts of a mask's surface are worth, and how far normals are off.
void tell_tilts(Row& row, const ContourSet& contours, const Mask& truth) {
    const TrueTiltsFit fit = segment_with_true_tilts(contours, truth.grid, blurred_normal(truth, kBlurVoxels));
    row.true_tilts = compare(fit.mask, truth);
    row.normals = normal_errors(contours, truth, row.function);
    row.true_tilts_normals = normal_errors(contours, truth, fit.function);
    row.normal_error_degrees = row.normals->all;
}

/// All drawings of a folder of objects, each a folder with `truth.nii.gz` and contour files.
std::vector<Row> measured_rows(const fs::path& root, bool with_paper, bool with_tilts) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(root))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<Row> rows;
    for (const fs::path& file : files) {
        const std::string object = file.parent_path().filename().string(), drawing = file.stem().string();
        fmt::print(stderr, "{} {}\n", object, drawing);
        const ContourSet contours = read_contours(file).contours;
        const Mask truth = read_mask(file.parent_path() / "truth.nii.gz");
        Row row = segment_both_ways(contours, truth, with_paper);
        if (with_tilts) tell_tilts(row, contours, truth);
        row.object = object;
        row.drawing = drawing;
        rows.push_back(row);
    }
    return rows;
}

nlohmann::ordered_json to_json(const Comparison& c) {
    nlohmann::ordered_json json{{"dice", c.dice}};
    if (c.surface) {
        json["hausdorff95_mm"] = c.surface->hausdorff95_mm;
        json["mean_surface_distance_mm"] = c.surface->mean_surface_distance_mm;
    }
    return json;
}

nlohmann::ordered_json to_json(const NormalErrors& errors) {
    return {{"degrees", errors.all}, {"in_plane_degrees", errors.in_plane}, {"of_truth_degrees", errors.truth}};
}

void print_json(const std::vector<Row>& rows) {
    auto list = nlohmann::ordered_json::array();
    for (const Row& row : rows) {
        nlohmann::ordered_json json{{"object", row.object},
                                    {"drawing", row.drawing},
                                    {"contours", row.contours},
                                    {"points", row.points},
                                    {"kontur", to_json(row.kontur)}};
        if (row.paper) json["paper"] = to_json(*row.paper);
        if (row.true_tilts) json["true_tilts"] = to_json(*row.true_tilts);
        if (row.normal_error_degrees) json["normal_error_degrees"] = *row.normal_error_degrees;
        if (row.normals) json["normals"] = to_json(*row.normals);
        if (row.true_tilts_normals) json["true_tilts_normals"] = to_json(*row.true_tilts_normals);
        list.push_back(json);
    }
    fmt::print("{}\n", list.dump(2));
}

int run(const std::vector<std::string>& arguments) {
    constexpr std::array kOptions{"--without-paper", "--without-phantom", "--tilts"};
    for (const std::string& argument : arguments)
        if (argument.starts_with("--") && std::ranges::find(kOptions, argument) == kOptions.end())
            throw Error(ErrorKind::invalid_input,
                        fmt::format("{} is no option; there are {}", argument, fmt::join(kOptions, ", ")));
    const auto is_given = [&](const char* option) { return std::ranges::find(arguments, option) != arguments.end(); };
    const bool with_paper = !is_given("--without-paper"), with_tilts = is_given("--tilts");
    std::vector<Row> rows;
    for (const std::string& argument : arguments) {
        if (argument.starts_with("--")) continue;
        const std::vector<Row> measured = measured_rows(argument, with_paper, with_tilts);
        rows.insert(rows.end(), measured.begin(), measured.end());
    }
    if (!is_given("--without-phantom")) {
        const std::vector<Row> phantom = phantom_rows(with_paper);
        rows.insert(rows.end(), phantom.begin(), phantom.end());
    }
    print_json(rows);
    return 0;
}

}  // namespace
}  // namespace kontur

/// accuracy [--without-paper] [--without-phantom] [--tilts] [FOLDER]...: folders as `measured_rows` takes them, then the
/// phantom, as JSON. Without the paper's method it takes a minute instead of many. With --tilts the folders' drawings are
/// also fitted with the tilts of the true masks, as the phantom's are.
int main(int count, char** arguments) {
    try {
        return kontur::run({arguments + 1, arguments + count});
    } catch (const std::exception& error) {
        fmt::print(stderr, "accuracy: error: {}\n", error.what());
        return 1;
    }
}
