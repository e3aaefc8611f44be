// SPDX-License-Identifier: Apache-2.0
#include "describe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <type_traits>
#include <variant>
#include <vector>

#include "kontur/base/error.h"

namespace kontur::app {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

Facts triple(const Vec3& v) { return {number(v.x), number(v.y), number(v.z)}; }

Facts extent(const Box3& box) {
    if (box.is_empty()) return Facts::array();
    return {triple(box.min), triple(box.max)};
}

std::array<Vec3, 3> unit_axes(const Grid& grid) {
    std::array<Vec3, 3> axes;
    for (int axis = 0; axis < 3; ++axis) axes[axis] = normalized(grid.index_to_mm.column(axis));
    return axes;
}

/// The patient axis (0: x, 1: y, 2: z) that each grid axis is nearest to, all three different.
std::array<int, 3> nearest_patient_axes(const std::array<Vec3, 3>& axes) {
    std::array<int, 3> best{0, 1, 2}, candidate = best;
    const auto agreement = [&](const std::array<int, 3>& order) {
        return std::abs(axes[0][order[0]]) + std::abs(axes[1][order[1]]) + std::abs(axes[2][order[2]]);
    };
    do {
        if (agreement(candidate) > agreement(best)) best = candidate;
    } while (std::next_permutation(candidate.begin(), candidate.end()));
    return best;
}

std::string axes_code(const std::array<Vec3, 3>& axes, const std::array<int, 3>& nearest) {
    std::string code;
    for (int axis = 0; axis < 3; ++axis) code += axes[axis][nearest[axis]] > 0 ? "LPS"[nearest[axis]] : "RAI"[nearest[axis]];
    return code;
}

double obliqueness_deg(const std::array<Vec3, 3>& axes, const std::array<int, 3>& nearest) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max(largest, std::acos(std::min(1.0, std::abs(axes[axis][nearest[axis]]))));
    return largest * kDegrees;
}

double shear_deg(const std::array<Vec3, 3>& axes) {
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max(largest, std::asin(std::min(1.0, std::abs(dot(axes[axis], axes[(axis + 1) % 3])))));
    return largest * kDegrees;
}

/// Rounding of the angles: directions in files carry about seven digits.
double angle(double degrees) { return std::round(degrees * 1e4) / 1e4; }

const char* sample_type(const Image& image) {
    constexpr std::array kNames{"uint8", "int16", "uint16", "int32", "float32"};
    return kNames[image.samples.index()];
}

/// Of the finite values, as among numbers NaN has no place in the order.
struct Range {
    double min = 0, max = 0;
    std::size_t finite = 0;
};

template <class Value>
Range range_of(const std::vector<Value>& values) {
    Value min = std::numeric_limits<Value>::max(), max = std::numeric_limits<Value>::lowest();
    std::size_t finite = 0;
    for (const Value value : values) {
        if constexpr (std::is_floating_point_v<Value>)
            if (!std::isfinite(value)) continue;
        min = std::min(min, value);
        max = std::max(max, value);
        ++finite;
    }
    return {static_cast<double>(min), static_cast<double>(max), finite};
}

/// Labels with their size; an empty list for an image that is no label map.
Facts labels(const Image& image) {
    constexpr std::size_t kMaxLabels = 256;
    Facts list = Facts::array();
    try {
        for (const auto& [label, voxels] : count_labels(image, kMaxLabels)) {
            const double volume_ml = static_cast<double>(voxels) * image.grid.voxel_volume_mm3() / 1000;
            list.push_back({{"label", label}, {"voxels", voxels}, {"volume_ml", volume_ml}});
        }
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::invalid_input) throw;
    }
    return list;
}

bool same_plane(const Plane& a, const Plane& b) {
    constexpr double kToleranceMm = 0.01, kParallel = 1 - 1e-6;
    return std::abs(dot(a.normal, b.normal)) > kParallel && std::abs(a.distance_to(b.origin)) < kToleranceMm;
}

std::size_t count_planes(const ContourSet& set) {
    std::vector<Plane> planes;
    for (const Contour& contour : set.contours)
        if (std::none_of(planes.begin(), planes.end(), [&](const Plane& p) { return same_plane(p, contour.plane); }))
            planes.push_back(contour.plane);
    return planes.size();
}

/// The moments at which contours were drawn, where they have any.
Facts moments(const ContourSet& set, std::optional<double> Contour::*moment) {
    std::set<double> found;
    for (const Contour& contour : set.contours)
        if (contour.*moment) found.insert(*(contour.*moment));
    return found;
}

}  // namespace

Facts describe(const Grid& grid) {
    const std::array<Vec3, 3> axes = unit_axes(grid);
    const std::array<int, 3> nearest = nearest_patient_axes(axes);
    return {
        {"size", {grid.size.i, grid.size.j, grid.size.k}},          {"spacing_mm", triple(grid.spacing_mm())},
        {"origin_mm", triple(grid.index_to_mm.translation)},        {"axes", axes_code(axes, nearest)},
        {"obliqueness_deg", angle(obliqueness_deg(axes, nearest))}, {"shear_deg", angle(shear_deg(axes))},
        {"left_handed", grid.index_to_mm.determinant() < 0},
    };
}

Facts describe(const Image& image) {
    Facts facts = describe(image.grid);
    const Range range = std::visit([](const auto& values) { return range_of(values); }, image.samples);
    const std::size_t count = std::visit([](const auto& values) { return values.size(); }, image.samples);
    facts["samples"] = sample_type(image);
    facts["min"] = range.finite > 0 ? number(range.min) : nullptr;
    facts["max"] = range.finite > 0 ? number(range.max) : nullptr;
    if (range.finite < count) facts["not_finite"] = count - range.finite;
    facts["labels"] = labels(image);
    return facts;
}

Facts describe(const ContourSet& set) {
    const auto holes = std::count_if(set.contours.begin(), set.contours.end(), [](const Contour& c) { return c.hole; });
    Facts facts = {
        {"name", set.name},
        {"planes", count_planes(set)},
        {"contours", set.contours.size()},
        {"holes", holes},
        {"points", point_count(set)},
        {"interior_points", set.interior.size()},
        {"exterior_points", set.exterior.size()},
        {"surface_points", set.surface.size()},
        {"empty_planes", set.empty_planes.size()},
        {"extent_mm", extent(bounding_box(set))},
        {"problems", contour_problems(set)},
    };
    if (const Facts frames = moments(set, &Contour::frame); !frames.empty()) facts["frames"] = frames;
    if (const Facts times = moments(set, &Contour::time_s); !times.empty()) facts["times_s"] = times;
    if (set.cycle_frames) facts["cycle_frames"] = *set.cycle_frames;
    if (set.cycle_s) facts["cycle_s"] = *set.cycle_s;
    return facts;
}

Facts describe(const StructureAttributes& attributes) {
    Facts facts = Facts::object();
    const auto words = [](const CodedConcept& code) {
        return fmt::format("{} ({}, {})", code.meaning, code.value, code.scheme);
    };
    if (attributes.number) facts["number"] = *attributes.number;
    if (!attributes.interpreted_type.empty()) facts["type"] = attributes.interpreted_type;
    if (attributes.color) facts["color"] = *attributes.color;
    if (!attributes.generation_algorithm.empty()) facts["generation_algorithm"] = attributes.generation_algorithm;
    if (!attributes.description.empty()) facts["description"] = attributes.description;
    if (attributes.category) facts["category"] = words(*attributes.category);
    if (attributes.code) facts["code"] = words(*attributes.code);
    for (const PhysicalProperty& one : attributes.physical_properties)
        facts["physical_properties"][one.property] = one.value;
    if (const auto& approved = attributes.review.approved) facts["approved"] = {{"by", approved->by}, {"at", approved->at}};
    if (!attributes.review.comment.empty()) facts["comment"] = attributes.review.comment;
    if (attributes.review.locked) facts["locked"] = true;
    return facts;
}

Facts describe(const TriangleMesh& mesh) {
    const MeshTopology shape = topology(mesh);
    // Of other meshes the sum depends on where the origin lies.
    const bool encloses = shape.closed && shape.oriented;
    const double volume_ml = signed_volume_mm3(mesh) / 1000;
    return {
        {"points", mesh.points.size()},
        {"triangles", mesh.triangles.size()},
        {"closed", shape.closed},
        {"oriented", shape.oriented},
        {"euler", shape.euler},
        {"components", shape.components},
        {"volume_ml", encloses ? number(std::abs(volume_ml)) : nullptr},
        {"faces_inwards", encloses ? Facts(volume_ml < 0) : nullptr},
        {"extent_mm", extent(bounding_box(mesh.points))},
    };
}

}  // namespace kontur::app
