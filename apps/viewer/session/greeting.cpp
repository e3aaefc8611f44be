// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "kontur/view/picture.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"
#include "viewer/session/page_json.h"
#include "viewer/session/replies.h"
#include "viewer/surfaces/clipped_volume.h"

// What a page is told when it comes, and what it keeps here.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kLargestPageState = 64 << 10;
constexpr double kMostBeyond = 0.01;  ///< of a surface: a contour on the last slice bulges a little beyond it

json view_json(const View& view, const std::string& title) {
    return {{"title", title},
            {"plane", to_json(view.plane)},
            {"step_mm", view.step_mm},
            {"width_mm", view.width_mm},
            {"height_mm", view.height_mm},
            {"range_mm", {view.from_mm, view.to_mm}}};
}

constexpr std::array<const char*, 3> kViews{"axial", "sagittal", "coronal"};  // by SliceKind

json views_json(const Grid& grid, const ViewNames& names) {
    json views{{"oblique", view_json(oblique_view(grid), "Oblique")}};
    for (const SliceKind kind : {SliceKind::axial, SliceKind::sagittal, SliceKind::coronal}) {
        const auto at = static_cast<std::size_t>(kind);
        views[kViews[at]] = view_json(view_of(grid, kind), names.titles[at]);
    }
    return views;
}

/// What the user should know where the surface leaves the image: all figures and files are of what lies within.
std::optional<std::string> cut_by_image(double whole_ml, double within_ml) {
    const double beyond_ml = whole_ml - within_ml;
    if (beyond_ml <= kMostBeyond * whole_ml) return std::nullopt;
    return fmt::format(
        "The image ends inside the structure: {} of its surface lie beyond. Volume, mask and surface files "
        "hold only what lies within the image.",
        in_ml(beyond_ml));
}

json corners_json(const Grid& grid) {
    json corners = json::array();
    for (const Vec3& corner : outer_corners(grid)) corners.push_back(to_json(corner));
    return corners;
}

/// A project may come from anywhere: what `page.save` would have refused is not given back.
json page_state(SessionState& s) {
    const std::string stored = s.project.page_state();
    if (stored.size() > kLargestPageState) return nullptr;
    try {
        return parsed(stored);
    } catch (const json::exception&) {
        return nullptr;
    } catch (const Error&) {
        return nullptr;
    }
}

json save_page(SessionState& s, const Members& m) {
    const std::string state = to_text(m.at("state"));
    if (state.size() > kLargestPageState)
        throw Error(ErrorKind::too_large,
                    fmt::format("'state' has {} bytes; the limit is {}", state.size(), kLargestPageState));
    s.project.save_page_state(state);
    return json::object();
}

/// What the corrections of a mask come to.
json correction_json(const MaskEdit& corrected, SurfaceStage stage) {
    const CorrectReport& report = corrected.report;
    json pieces = json::array();
    for (const LoosePiece& piece : report.loose_pieces)
        pieces.push_back({{"at", to_json(piece.position)}, {"volume_ml", piece.volume_ml}, {"voxels", piece.voxels}});
    double move_mm = 0;
    for (const CorrectedPlane& plane : report.planes) move_mm = std::max(move_mm, plane.largest_move_mm);
    json told{{"text", sentence(report)},
              {"voxels", report.added_drawn + report.removed_drawn + report.added_carried + report.removed_carried +
                             report.added_image + report.removed_image},
              {"volume_before_ml", report.volume_before_ml},
              {"volume_ml", report.volume_ml},
              {"move_mm", move_mm},
              {"reach_mm", report.reach_mm},
              {"loose", std::move(pieces)},
              {"dropped", report.dropped_loose}};
    if (corrected.step) told["step"] = {{"voxels", corrected.step->voxels}, {"more_ml", corrected.step->more_ml}};
    if (corrected.followed > 0) told["followed"] = corrected.followed;
    if (report.image && stage == SurfaceStage::finished) told["image"] = sentence(*report.image);
    return told;
}

json ping(SessionState&, const Members&) { return json::object(); }

}  // namespace

Calls page_calls() { return {{"page.save", {save_page}}, {"ping", {ping, false}}}; }

std::string greeting(SessionState& s, const json& more) {
    const std::scoped_lock lock(s.mutex);
    json structures = json::array(), contours = json::array(), surfaces = json::array(), motions = json::array();
    PageJson page_json;
    for (const auto& [id, structure] : s.project.state().structures) structures.push_back(to_json(structure));
    for (const auto& [id, contour] : s.project.state().contours) contours.push_back(page_json(*contour));
    for (const auto& [id, surface] : s.surfaces.all())
        if (s.project.state().structures.contains(id)) surfaces.push_back(surface_event(s, *surface));
    for (const auto& [id, motion] : s.surfaces.motions().all())
        if (s.project.state().structures.contains(id)) motions.push_back(motion_json(*motion));
    const Grid& grid = s.image.voxels->grid;
    const ViewNames names = view_names(grid);
    json event{{"event", "session"},
               {"version", KONTUR_VERSION},
               {"title", s.image.title},
               {"project", s.project.path().filename().string()},
               {"project_path", std::filesystem::absolute(s.project.path()).string()},
               {"read_only", s.project.is_read_only()},
               {"image",
                {{"size", {grid.size.i, grid.size.j, grid.size.k}},
                 {"spacing_mm", to_json(grid.spacing_mm())},
                 {"corners", corners_json(grid)},
                 {"center", to_json(grid.bounds_mm().center())},
                 {"unit", s.image.unit},
                 {"range", {s.image.range.first, s.image.range.second}},
                 {"times", s.image.times.count()},
                 {"time", s.image.times.own()},
                 {"notes", s.notes}}},
               {"identity", to_json(s.image.identity)},
               {"frame_of_reference_uid", s.image.frame_of_reference_uid},
               {"images", further_images_json(s)},
               {"has_dicom", s.image.series.has_value()},
               {"window", {{"center", s.image.window.center}, {"width", s.image.window.width}}},
               {"presets", to_json(s.image.presets)},
               {"views", views_json(grid, names)},
               {"first_view", kViews[static_cast<std::size_t>(names.first)]},
               {"structures", structures},
               {"contours", contours},
               {"surfaces", surfaces},
               {"motions", motions},
               {"cycle_frames", cycle_json(s)},
               {"borders", to_json(s.project.state().borders)},
               {"use_image", use_image_json(s)},
               {"border_pairs", to_json(s.surfaces.border_pairs())},
               {"history", history_json(s)},
               {"imports", {{"contours", kContourEndings}, {"masks", kMaskEndings}}},
               {"page", page_state(s)}};
    event.update(more);
    return to_text(event);
}

json surface_event(const SessionState& s, const Surface& surface) {
    json event{{"event", "surface"},
               {"structure", surface.structure},
               {"revision", surface.revision},
               {"stage", std::string(name(surface.stage))},
               {"triangles", surface.mesh ? surface.mesh->triangles.size() : 0},
               {"warnings", surface.warnings}};
    if (surface.time) event["time"] = *surface.time;
    for (const LineSide& side : surface.sides)
        event["sides"].push_back(
            {{"contour", side.contour}, {"inside", std::string(kontur::name(side.inside))}, {"sure", side.is_sure}});
    for (const LinePair& pair : surface.near_lines)
        event["near_lines"].push_back(
            {{"contours", {pair.contour, pair.other}}, {"apart_mm", pair.apart_mm}, {"one", pair.is_one}});
    if (has_full_resolution(surface.stage) || surface.stage == SurfaceStage::none) {
        event["conflicts"] = json::array();
        for (const Conflict& conflict : surface.conflicts)
            event["conflicts"].push_back({{"at", to_json(conflict.at)},
                                          {"distance_mm", conflict.disagreement_mm},
                                          {"contours", {conflict.contour, conflict.other}}});
    }
    if (surface.corrected) event["correction"] = correction_json(*surface.corrected, surface.stage);
    if (!has_full_resolution(surface.stage)) return event;
    if (surface.corrected) {
        event["volume_ml"] = surface.volume_ml;
        return event;
    }
    if (surface.is_derived) {
        event["volume_ml"] = volume_within_mm3(*surface.mesh, s.image.voxels->grid) / 1000;
        return event;
    }
    if (surface.image.verdict != ImageVerdict::none)
        event["image"] = {{"verdict", std::string(name(surface.image.verdict))}, {"text", sentence(surface.image)}};
    const double within_ml = volume_within_mm3(*surface.mesh, s.image.voxels->grid) / 1000;
    event["volume_ml"] = within_ml;
    if (auto sentence = cut_by_image(surface.volume_ml, within_ml)) event["warnings"].push_back(*sentence);
    event["faults"] = to_json(surface.faults);
    for (const EdgeBeside& one : surface.edges_beside)
        event["edges_beside"].push_back({{"contour", one.contour}, {"offset_mm", one.offset_mm}});
    event["residual"] = {
        {"max_mm", surface.residual.max_mm}, {"rms_mm", surface.residual.rms_mm}, {"at", to_json(surface.worst_at)}};
    if (surface.worst_contour != 0) event["residual"]["contour"] = surface.worst_contour;
    if (surface.evidence) event["uncertainty"] = to_json(surface_uncertainty(evidence_of(s, surface)));
    return event;
}

}  // namespace kontur::viewer
