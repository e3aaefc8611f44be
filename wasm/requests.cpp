// SPDX-License-Identifier: Apache-2.0
#include "requests.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/io/contours/contour_json.h"

namespace kontur::wasm {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::invalid_input, problem); }

json parsed(std::string_view text) {
    json value = json::parse(text, nullptr, false);
    if (!value.is_object()) refuse("a request is an object of JSON");
    return value;
}

double number_of(const json& value, std::string_view key) {
    if (!value.is_number()) refuse(fmt::format("{} is no number", key));
    return value.get<double>();
}

Vec3 vector_from(const json& value, std::string_view key) {
    if (!value.is_array() || value.size() != 3) refuse(fmt::format("{} is no list of 3 numbers", key));
    return {number_of(value[0], key), number_of(value[1], key), number_of(value[2], key)};
}

Grid grid_from(const json& value) {
    if (!value.is_object() || !value.contains("size") || !value.contains("indexToMm"))
        refuse("grid has no size and indexToMm");
    const Vec3 size = vector_from(value["size"], "grid.size");
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kMostOfAnAxis = 1e6;
        const double count = axis == 0 ? size.x : axis == 1 ? size.y : size.z;
        if (!(count >= 1 && count <= kMostOfAnAxis))
            refuse(fmt::format("grid.size has {:g}; it takes 1 to {:g} voxels along each axis", count, kMostOfAnAxis));
        grid.size[axis] = static_cast<std::int64_t>(count);
    }
    const json& rows = value["indexToMm"];
    if (!rows.is_array() || rows.size() != 3) refuse("grid.indexToMm is no list of 3 rows");
    std::array<double, 3> translation{};
    for (std::size_t row = 0; row < 3; ++row) {
        if (!rows[row].is_array() || rows[row].size() != 4) refuse("a row of grid.indexToMm is no list of 4 numbers");
        for (std::size_t column = 0; column < 3; ++column)
            grid.index_to_mm.linear[row][column] = number_of(rows[row][column], "grid.indexToMm");
        translation[row] = number_of(rows[row][3], "grid.indexToMm");
    }
    grid.index_to_mm.translation = {translation[0], translation[1], translation[2]};
    check_grid(grid);
    return grid;
}

/// Around the contours; by default 128 voxels along their diagonal and a quarter of it to spare on each side.
Grid grid_around_contours(const ContourSet& contours, const json& request) {
    constexpr double kVoxels = 128, kMargin = 0.25;
    const Box3 box = bounding_box(contours);
    if (box.is_empty()) refuse("there is no contour");
    const double spacing =
        request.contains("spacingMm") ? number_of(request["spacingMm"], "spacingMm") : box.diagonal() / kVoxels;
    if (!(spacing > 0)) refuse(fmt::format("spacingMm is {:g}; it has to be above 0", spacing));
    return grid_around(box, {spacing, spacing, spacing}, kMargin * box.diagonal());
}

template <class Value>
void choose(Value& chosen, const json& options, const char* key, std::initializer_list<Value> values) {
    if (!options.contains(key)) return;
    std::string known;
    for (const Value value : values) {
        if (options[key] == name(value)) {
            chosen = value;
            return;
        }
        known += (known.empty() ? "" : ", ") + std::string(name(value));
    }
    refuse(fmt::format("{} is {}; it takes {}", key, options[key].dump(), known));
}

SegmentOptions options_from(const json& given) {
    SegmentOptions options;
    choose(options.kernel, given, "kernel", {Kernel::screened, Kernel::triharmonic, Kernel::biharmonic});
    choose(options.normals, given, "normals", {Normals::surface, Normals::in_plane});
    choose(options.conflicts, given, "conflicts", {Conflicts::reconcile, Conflicts::newest_wins, Conflicts::exact});
    choose(options.fill_rule, given, "fillRule", {FillRule::even_odd, FillRule::declared});
    choose(options.corners, given, "corners", {Corners::rounded, Corners::faithful});
    choose(options.use_image, given, "useImage", {UseImage::automatic, UseImage::off});
    for (const auto& [key, place] :
         {std::pair("normalOffsetMm", &options.normal_offset_mm), std::pair("smoothing", &options.smoothing),
          std::pair("toleranceMm", &options.tolerance_mm)})
        if (given.contains(key)) *place = number_of(given[key], key);
    if (given.contains("quality")) options.quality = number_of(given["quality"], "quality");
    options.mesh = given.value("mesh", true);
    return options;
}

FillOptions fill_options_from(const json& given) {
    FillOptions options;
    choose(options.ends, given, "ends", {FillEnds::closed, FillEnds::half, FillEnds::open});
    choose(options.use_image, given, "useImage", {UseImage::automatic, UseImage::off});
    for (const auto& [key, place] :
         {std::pair("shapeWeight", &options.shape_weight), std::pair("smoothingVoxels", &options.smoothing_voxels)})
        if (given.contains(key)) *place = number_of(given[key], key);
    if (given.contains("jointly") && !given["jointly"].is_boolean()) refuse("jointly is neither true nor false");
    options.jointly = given.value("jointly", options.jointly);
    if (!given.contains("labels")) return options;
    if (!given["labels"].is_array()) refuse("labels is no list of numbers");
    for (const json& label : given["labels"])
        options.labels.push_back(static_cast<std::int64_t>(number_of(label, "labels")));
    return options;
}

}  // namespace

FillRequest fill_request_from(std::string_view text) {
    const json request = parsed(text);
    if (!request.contains("grid")) refuse("the request has no grid");
    return {grid_from(request["grid"]), request.value("labelsType", ""), request.value("imageType", ""),
            fill_options_from(request.value("options", json::object()))};
}

Grid grid_from(std::string_view text) { return grid_from(parsed(text)); }

Request request_from(std::string_view text) {
    const json request = parsed(text);
    if (!request.contains("contours")) refuse("the request has no contours");
    Request result{.contours = parse_contour_json(request["contours"].dump()), .grid = {}, .options = {}};
    result.grid = request.contains("grid") ? grid_from(request["grid"]) : grid_around_contours(result.contours, request);
    result.options = options_from(request.value("options", json::object()));
    return result;
}

Plane plane_from(std::string_view text) {
    const json plane = parsed(text);
    if (!plane.contains("origin") || !plane.contains("normal")) refuse("a plane has an origin and a normal");
    return make_plane(vector_from(plane["origin"], "origin"), vector_from(plane["normal"], "normal"));
}

json to_json(const Grid& grid) {
    const auto& [linear, move] = grid.index_to_mm;
    json rows = json::array();
    const std::array<double, 3> translation{move.x, move.y, move.z};
    for (std::size_t row = 0; row < 3; ++row)
        rows.push_back({linear[row][0], linear[row][1], linear[row][2], translation[row]});
    return {{"size", {grid.size.i, grid.size.j, grid.size.k}}, {"indexToMm", rows}};
}

}  // namespace kontur::wasm
