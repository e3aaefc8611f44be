// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/refine/suggest_plane.h"
#include "viewer/model_json.h"
#include "viewer/proposed_lines.h"
#include "viewer/session.h"

// Where to draw next.

namespace kontur::viewer {
namespace {

using nlohmann::json;

}  // namespace

SurfaceEvidence Session::evidence_of(const Surface& surface) const {
    SurfaceEvidence evidence = *surface.evidence;
    const Vec3 spacing = image_->grid.spacing_mm();
    evidence.voxel_mm = std::min({spacing.x, spacing.y, spacing.z});
    return evidence;
}

json Session::suggest(const Members& m) {
    const Id structure = m.id("structure");
    SuggestPlaneOptions options{.planes = m.flag_or("slices", false) ? PlaneChoice::image_slices : PlaneChoice::any};
    if (m.has("skip")) options.avoid = m.planes("skip");
    options.grid = image_->grid;
    const auto surfaces = surfaces_.all();
    const auto found = surfaces.find(structure);
    json planes = json::array();
    // While contours change there is no surface of them yet, and none to suggest a plane for.
    if (found == surfaces.end() || !found->second->evidence || !is_finished(found->second->stage))
        return {{"planes", planes}};
    const Surface& surface = *found->second;
    for (const SuggestedPlane& one : suggest_planes(evidence_of(surface), *surface.drawn, 1, options).planes) {
        json lines = json::array();
        for (const Polyline& line : proposed_lines(*surface.mesh, one.plane)) lines.push_back(to_json(line.points));
        json told{{"plane", to_json(one.plane)}, {"gain", one.gain}, {"lines", std::move(lines)}};
        if (one.slice) told["slice"] = {{"axis", one.slice->axis}, {"index", one.slice->index}};
        if (one.after.value > 0) told["expected_dice"] = to_json(one.after);
        planes.push_back(std::move(told));
    }
    return {{"planes", std::move(planes)}};
}

}  // namespace kontur::viewer
