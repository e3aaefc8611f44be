// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <span>

#include "kontur/measure/surface_distance.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "viewer/model/binary_reply.h"
#include "viewer/model/model_json.h"
#include "viewer/session/events.h"
#include "viewer/session/replies.h"
#include "viewer/surfaces/mesh_code.h"

// The surface of a structure, as numbers or in few bytes.

namespace kontur::viewer {
namespace {

std::vector<float> floats(const std::vector<Vec3>& points) {
    std::vector<float> numbers;
    numbers.reserve(3 * points.size());
    for (const Vec3& p : points)
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(p[axis]));
    return numbers;
}

std::string as_numbers(nlohmann::json head, const TriangleMesh& mesh, const std::vector<double>& widths_mm) {
    BinaryReply reply(std::move(head));
    reply.add<float>("positions", floats(mesh.points));
    reply.add<float>("normals", floats(mesh.normals));
    if (!widths_mm.empty()) reply.add<float>("half_widths_mm", std::vector<float>(widths_mm.begin(), widths_mm.end()));
    reply.add("triangles",
              std::span(reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()), 3 * mesh.triangles.size()));
    return reply.bytes();
}

std::string as_code(nlohmann::json head, const TriangleMesh& mesh, const std::vector<double>& widths_mm,
                    const std::vector<double>& away_mm, std::span<const std::uint8_t> origins) {
    const MeshCode code = code_mesh(mesh);
    const WidthCode widths = code_widths(widths_mm), distances = code_distances(away_mm);
    head["points"] = mesh.points.size();
    head["triangles"] = mesh.triangles.size();
    head["origin"] = to_json(code.origin);
    head["step_mm"] = to_json(code.step_mm);
    head["half_width_step_mm"] = widths.step_mm;
    head["distance_step_mm"] = distances.step_mm;
    BinaryReply reply(std::move(head));
    reply.add<std::uint8_t>("positions", code.positions);
    reply.add<std::uint8_t>("normals", code.normals);
    reply.add<std::uint8_t>("half_widths", widths.steps);
    reply.add<std::uint8_t>("distances", distances.steps);
    reply.add<std::uint8_t>("origins", origins);
    reply.add<std::uint8_t>("triangles", code.triangles);
    return reply.bytes();
}

/// Of a structure that moves.
std::vector<double> widths_in_time(const SessionState& s, Id structure, int time, const TriangleMesh& mesh) {
    const auto motion = s.surfaces.motions().of(structure);
    if (!motion || !motion->sureness || !motion->is_finished) return {};
    const double frame = time + 1;
    return motion->sureness->half_widths_mm(mesh.points, motion->meshes->changes(mesh.points, frame), frame);
}

}  // namespace

std::string mesh_reply(const SessionState& s, Id structure, bool coded, const MeshExtras& extras) {
    const auto surfaces = s.surfaces.all();
    const auto seen = s.surfaces.at(extras.time.value_or(s.image.times.own()));
    const TriangleMesh no_mesh;
    const auto surface_of = [&](Id id) {
        const auto found = seen.find(id);
        if (found == seen.end() || !found->second.mesh || !s.state().structures.contains(id)) return Surface{};
        Surface surface = *surfaces.at(id);
        if (surface.mesh != found->second.mesh) surface.evidence = nullptr;  // that is of another time
        surface.mesh = found->second.mesh;
        surface.revision = found->second.revision;
        surface.stage = found->second.stage;
        return surface;
    };
    const auto mesh_of = [&](const Surface& surface) -> const TriangleMesh& {
        return surface.mesh ? *surface.mesh : no_mesh;
    };
    const Surface surface = surface_of(structure);
    const TriangleMesh& mesh = mesh_of(surface);
    std::vector<double> widths_mm;
    if (extras.widths && surface.evidence && has_full_resolution(surface.stage))
        widths_mm = half_widths_mm(evidence_of(s, surface), mesh.points);
    else if (extras.widths && surface.stage == SurfaceStage::finished)
        widths_mm = widths_in_time(s, structure, extras.time.value_or(s.image.times.own()), mesh);
    nlohmann::json head{
        {"structure", structure}, {"revision", surface.revision}, {"stage", std::string(name(surface.stage))}};
    if (!coded) return as_numbers(std::move(head), mesh, widths_mm);
    std::vector<double> away_mm;
    if (extras.far_from) {
        const Surface other = surface_of(*extras.far_from);
        away_mm = distances_mm(mesh.points, mesh_of(other));
    }
    std::span<const std::uint8_t> origins;
    if (extras.origins && surface.corrected && surface.corrected->mesh == surface.mesh) origins = surface.corrected->origins;
    return as_code(std::move(head), mesh, widths_mm, away_mm, origins);
}

}  // namespace kontur::viewer
