// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model/model_json.h"
#include "viewer/model/single_points.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"

// Single points that a structure's surface passes, or that lie inside or outside of it. They are named by where they are:
// numbers would be others as soon as another page has removed one.

namespace kontur::viewer {
namespace {

using nlohmann::json;

enum class PointKind { surface, interior, exterior };

/// One of a structure's single points.
struct FoundPoint {
    PointKind kind = PointKind::surface;
    std::ptrdiff_t index = 0;  ///< among those of its kind
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

PointKind kind_of(const Members& m) {
    const std::string word = m.has("kind") ? m.text("kind", 16) : "surface";
    if (word == "interior") return PointKind::interior;
    return word == "exterior" ? PointKind::exterior : PointKind::surface;
}

std::vector<Vec3>& side(Structure& structure, PointKind kind) {
    return kind == PointKind::interior ? structure.interior : structure.exterior;
}

std::optional<FoundPoint> find_point(Structure& structure, const Vec3& at) {
    const auto& surface = structure.surface_points;
    const auto on = std::find_if(surface.begin(), surface.end(), [&](const SurfacePoint& p) { return p.position == at; });
    if (on != surface.end()) return FoundPoint{PointKind::surface, on - surface.begin()};
    for (const PointKind kind : {PointKind::interior, PointKind::exterior}) {
        const std::vector<Vec3>& points = side(structure, kind);
        if (const auto found = std::find(points.begin(), points.end(), at); found != points.end())
            return FoundPoint{kind, found - points.begin()};
    }
    return std::nullopt;
}

FoundPoint known_point(Structure& structure, const Vec3& at) {
    const auto found = find_point(structure, at);
    if (!found) refuse(fmt::format("{} has no point at {:.6g}, {:.6g}, {:.6g}", structure.name, at.x, at.y, at.z));
    return *found;
}

void check_is_new(Structure& structure, const Vec3& at) {
    if (find_point(structure, at)) refuse(structure.name + " has a point there already");
}

void append_point(Structure& structure, PointKind kind, const Vec3& at) {
    if (kind == PointKind::surface) structure.surface_points.push_back({at, {}});
    else side(structure, kind).push_back(at);
}

void erase_point(Structure& structure, const FoundPoint& point) {
    if (point.kind == PointKind::surface) structure.surface_points.erase(structure.surface_points.begin() + point.index);
    else side(structure, point.kind).erase(side(structure, point.kind).begin() + point.index);
}

std::string_view where(PointKind kind) {
    if (kind == PointKind::interior) return "inside of";
    return kind == PointKind::exterior ? "outside of" : "on";
}

json put_points(SessionState& s, const std::string& label, const Structure& after) {
    check_is_drawn(s.project.state(), after.id);
    ContourSet set = contour_set(s.project.state(), after.id);
    if (set.contours.empty() && !after.mask) refuse(after.name + " has no contour yet, and a point alone makes no surface");
    ContourSet wanted = without_contours(after);
    wanted.contours = std::move(set.contours);
    check_single_points(wanted);
    // Contours that cannot be followed are told with the surface.
    // Of a mask to be corrected they are pieces of its outlines, and no set by themselves.
    if (!after.mask)
        if (const auto problems = set_problems(wanted); !problems.empty()) refuse(problems.front());
    commit(s, {label + " " + after.name, {{after.id, structure_of(s.project.state(), after.id), after}}, {}});
    return {{"structure", to_json(after)}};
}

/// A mask is corrected by what lies inside and outside.
void check_kind(const Structure& structure, PointKind kind) {
    if (structure.mask && kind == PointKind::surface)
        refuse(fmt::format("{} is a mask to be corrected: its points lie inside or outside, not on the surface",
                           structure.name));
}

json add_single_point(SessionState& s, const Members& m) {
    Structure structure = structure_of(s.project.state(), m.id("structure"));
    check_kind(structure, kind_of(m));
    check_is_new(structure, m.point("at"));
    append_point(structure, kind_of(m), m.point("at"));
    return put_points(s, fmt::format("Point {}", where(kind_of(m))), structure);
}

json move_single_point(SessionState& s, const Members& m) {
    Structure structure = structure_of(s.project.state(), m.id("structure"));
    const auto [kind, index] = known_point(structure, m.point("at"));
    check_is_new(structure, m.point("to"));
    const auto i = static_cast<std::size_t>(index);
    // Which way is out was said of another place.
    if (kind == PointKind::surface) structure.surface_points[i] = {m.point("to"), {}};
    else side(structure, kind)[i] = m.point("to");
    return put_points(s, fmt::format("Move a point {}", where(kind)), structure);
}

json set_single_point(SessionState& s, const Members& m) {
    Structure structure = structure_of(s.project.state(), m.id("structure"));
    const FoundPoint point = known_point(structure, m.point("at"));
    check_kind(structure, kind_of(m));
    if (point.kind == kind_of(m)) return {{"structure", to_json(structure)}};
    erase_point(structure, point);
    append_point(structure, kind_of(m), m.point("at"));
    return put_points(s, fmt::format("Point {}", where(kind_of(m))), structure);
}

json remove_single_point(SessionState& s, const Members& m) {
    Structure structure = structure_of(s.project.state(), m.id("structure"));
    const FoundPoint point = known_point(structure, m.point("at"));
    erase_point(structure, point);
    commit(s, {fmt::format("Remove a point {} {}", where(point.kind), structure.name),
               {{structure.id, structure_of(s.project.state(), structure.id), structure}},
               {}});
    return {{"structure", to_json(structure)}};
}

}  // namespace

void check_single_points(const ContourSet& set) {
    const std::size_t count = set.surface.size() + set.interior.size() + set.exterior.size();
    if (count > kMostSinglePoints)
        throw Error(ErrorKind::too_large,
                    fmt::format("{} has {} single points; the limit is {}", set.name, count, kMostSinglePoints));
}

Calls point_calls() {
    return {{"point.add", {add_single_point}},
            {"point.move", {move_single_point}},
            {"point.set", {set_single_point}},
            {"point.remove", {remove_single_point}}};
}

}  // namespace kontur::viewer
