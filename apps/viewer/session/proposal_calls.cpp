// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/suggest_moving.h"
#include "viewer/edits/proposed_lines.h"
#include "viewer/edits/sketch.h"
#include "viewer/edits/snapped_line.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/surfaces/clipped_volume.h"

// Where to draw next, and what is proposed there.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr double kMostSlicesApart = 4;  ///< beyond, an image looks no more like itself

double apart_mm(const DrawnContour& contour, const Plane& plane) {
    return std::abs(plane.distance_to(contour.plane.origin));
}

/// On average from the line's points to the contour's next ones, seen along the plane's normal.
double mean_distance_mm(const std::vector<Vec3>& line, const DrawnContour& contour, const Plane& plane) {
    double sum = 0;
    for (const Vec3& p : line) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& q : contour.points) {
            const Vec3 away = q - p;
            nearest = std::min(nearest, norm(away - dot(away, plane.normal) * plane.normal));
        }
        sum += nearest;
    }
    return sum / static_cast<double>(line.size());
}

/// Where a structure's outline is asked for.
struct Section {
    Id structure;
    Plane plane;
    int time;
};

/// Of the structure's contours of the time on the nearest parallel slice with any the one that runs along the line; null:
/// there is none.
const DrawnContour* neighbour_of(const std::vector<Vec3>& line, const Section& section, const State& state, double most_mm) {
    const auto& [structure, plane, time] = section;
    std::vector<const DrawnContour*> near;
    double least_mm = most_mm;
    for (const auto& [id, contour] : state.contours) {
        if (contour->structure != structure || !contour->closed || !contour->visible) continue;
        if (time_of(state, *contour) != time) continue;
        if (std::abs(dot(contour->plane.normal, plane.normal)) < 1 - 1e-6) continue;
        const double mm = apart_mm(*contour, plane);
        if (mm > least_mm + 1e-3 || mm < 1e-3) continue;
        if (mm < least_mm - 1e-3) near.clear(), least_mm = mm;
        near.push_back(contour.get());
    }
    const auto nearest = std::ranges::min_element(
        near, {}, [&](const DrawnContour* contour) { return mean_distance_mm(line, *contour, plane); });
    return nearest == near.end() ? nullptr : *nearest;
}

/// What is fitted on a slice that no view shows yet.
json outline_of(SessionState& s, const Members& m) {
    const Id structure = m.id("structure");
    const Plane plane = m.plane("plane");
    const int time = m.time().value_or(s.image.times.own());
    const auto surfaces = s.surfaces.at(time);
    const auto found = surfaces.find(structure);
    json lines = json::array();
    if (found == surfaces.end() || !found->second.mesh) return {{"lines", std::move(lines)}};
    const State now = s.state();
    const bool snaps = m.flag_or("snap", false) && s.image.shows_borders && now.use_image;
    const Vec3 spacing = s.image.voxels->grid.spacing_mm();
    const double most_mm = kMostSlicesApart * std::max({spacing.x, spacing.y, spacing.z});
    for (Polyline& line : proposed_lines(*found->second.mesh, plane)) {
        const DrawnContour* beside = snaps ? neighbour_of(line.points, {structure, plane, time}, now, most_mm) : nullptr;
        if (beside)
            line.points =
                thinned(snapped_line({line.points, plane}, {beside->points, beside->plane}, *s.image.times.image(time)));
        lines.push_back(to_json(line.points));
    }
    return {{"lines", std::move(lines)}};
}

json lines_in(const TriangleMesh& mesh, const Plane& plane) {
    json lines = json::array();
    for (const Polyline& line : proposed_lines(mesh, plane)) lines.push_back(to_json(line.points));
    return lines;
}

/// A frame and a plane in it; the `skip`ped ones come before.
json suggest_in_time(const SessionState& s, const Motion& motion, std::size_t skip, SuggestPlaneOptions options) {
    json planes = json::array();
    if (!motion.is_finished || !motion.volumes || !motion.fit) return {{"planes", planes}};
    std::vector<double> times(motion.frames.size());
    std::iota(times.begin(), times.end(), 1);
    const MotionEvidence evidence{times, *motion.volumes, motion.fit->function, motion.fit->moments};
    const std::vector<MovingSuggestion> found = suggest_moving(evidence, skip + 1, options);
    if (found.size() <= skip) return {{"planes", planes}};
    const MovingSuggestion& one = found[skip];
    const auto seen = s.surfaces.at(static_cast<int>(one.frame));
    const auto own = seen.find(motion.structure);
    json lines = own == seen.end() || !own->second.mesh ? json::array() : lines_in(*own->second.mesh, one.plane);
    planes.push_back({{"plane", to_json(one.plane)}, {"gain", 0}, {"lines", std::move(lines)}, {"time", one.frame}});
    if (one.slice) planes.back()["slice"] = {{"axis", one.slice->axis}, {"index", one.slice->index}};
    return {{"planes", std::move(planes)}};
}

json suggest(SessionState& s, const Members& m) {
    const Id structure = m.id("structure");
    SuggestPlaneOptions options{.planes = m.flag_or("slices", false) ? PlaneChoice::image_slices : PlaneChoice::any};
    options.grid = s.image.voxels->grid;
    const std::vector<Plane> skipped = m.has("skip") ? m.planes("skip") : std::vector<Plane>{};
    if (const auto motion = s.surfaces.motions().of(structure); motion && !motion->frames.empty())
        return suggest_in_time(s, *motion, skipped.size(), options);
    options.avoid = skipped;
    const auto surfaces = s.surfaces.all();
    const auto found = surfaces.find(structure);
    json planes = json::array();
    // While contours change there is no surface of them yet, and none to suggest a plane for.
    if (found == surfaces.end() || !found->second->evidence || !has_full_resolution(found->second->stage))
        return {{"planes", planes}};
    const Surface& surface = *found->second;
    for (const SuggestedPlane& one : suggest_planes(evidence_of(s, surface), *surface.drawn, 1, options).planes) {
        json proposal{{"plane", to_json(one.plane)}, {"gain", one.gain}, {"lines", lines_in(*surface.mesh, one.plane)}};
        if (one.slice) proposal["slice"] = {{"axis", one.slice->axis}, {"index", one.slice->index}};
        if (one.after.value > 0) proposal["expected_dice"] = to_json(one.after);
        planes.push_back(std::move(proposal));
    }
    return {{"planes", std::move(planes)}};
}

}  // namespace

Calls proposal_calls() { return {{"outline", {outline_of, false}}, {"suggest", {suggest, false}}}; }

SurfaceEvidence evidence_of(const SessionState& s, const Surface& surface) {
    SurfaceEvidence evidence = *surface.evidence;
    const Vec3 spacing = s.image.voxels->grid.spacing_mm();
    evidence.voxel_mm = std::min({spacing.x, spacing.y, spacing.z});
    evidence.volume_mm3 = volume_within_mm3(*surface.mesh, s.image.voxels->grid);
    return evidence;
}

}  // namespace kontur::viewer
