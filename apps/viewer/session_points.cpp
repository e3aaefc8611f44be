// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "viewer/model_json.h"
#include "viewer/session.h"

// Single points that a structure's surface passes. They are named by where they are: numbers would be others as soon as
// another page has removed one.

namespace kontur::viewer {
namespace {

using nlohmann::json;
using Points = std::vector<SurfacePoint>;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

Points::iterator point_at(Points& points, const Vec3& at) {
    return std::find_if(points.begin(), points.end(), [&](const SurfacePoint& p) { return p.position == at; });
}

Points::iterator known_point(Points& points, const Vec3& at, const Structure& structure) {
    const auto found = point_at(points, at);
    if (found == points.end())
        refuse(fmt::format("{} has no surface point at {:.6g}, {:.6g}, {:.6g}", structure.name, at.x, at.y, at.z));
    return found;
}

/// Contours that cannot be followed are told with the surface.
void check_points(const ContourSet& set) {
    if (const auto problems = set_problems(set); !problems.empty()) refuse(problems.front());
}

void check_is_new(Points& points, const Vec3& at, const Structure& structure) {
    if (point_at(points, at) != points.end()) refuse(structure.name + " has a surface point there already");
}

}  // namespace

json Session::put_points(const std::string& label, const Structure& before, Points points) {
    Structure after = before;
    after.surface_points = std::move(points);
    commit({label + after.name, {{after.id, before, after}}, {}});
    return {{"structure", to_json(after)}};
}

json Session::add_surface_point(const Members& m) {
    const Structure structure = structure_of(project_.state(), m.id("structure"));
    ContourSet set = contour_set(project_.state(), structure.id);
    if (set.contours.empty()) refuse(structure.name + " has no contour yet, and a point alone makes no surface");
    if (set.surface.size() >= kMostSurfacePoints)
        refuse(fmt::format("{} has {} surface points; the limit is {}", structure.name, set.surface.size(),
                           kMostSurfacePoints));
    check_is_new(set.surface, m.point("at"), structure);
    set.surface.push_back({m.point("at"), {}});
    check_points(set);
    return put_points("Point on ", structure, std::move(set.surface));
}

json Session::move_surface_point(const Members& m) {
    const Structure structure = structure_of(project_.state(), m.id("structure"));
    ContourSet set = contour_set(project_.state(), structure.id);
    const auto moved = known_point(set.surface, m.point("at"), structure);
    check_is_new(set.surface, m.point("to"), structure);
    *moved = {m.point("to"), {}};  // which way is out was said of another place
    check_points(set);
    return put_points("Move a point on ", structure, std::move(set.surface));
}

json Session::remove_surface_point(const Members& m) {
    const Structure structure = structure_of(project_.state(), m.id("structure"));
    Points points = structure.surface_points;
    points.erase(known_point(points, m.point("at"), structure));
    return put_points("Remove a point on ", structure, std::move(points));
}

}  // namespace kontur::viewer
