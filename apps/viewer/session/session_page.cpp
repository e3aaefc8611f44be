// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/sureness/surface_uncertainty.h"
#include "viewer/model/model_json.h"
#include "viewer/session/session.h"
#include "viewer/session/told.h"

// What a page is told when it comes, and what it keeps here.

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kLargestPageState = 64 << 10;

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

json corners_json(const Grid& grid) {
    json corners = json::array();
    for (const Vec3& corner : outer_corners(grid)) corners.push_back(to_json(corner));
    return corners;
}

}  // namespace

std::string Session::greeting(const json& more) {
    const std::scoped_lock lock(mutex_);
    json structures = json::array(), contours = json::array(), surfaces = json::array();
    Told told;
    for (const auto& [id, structure] : project_.state().structures) structures.push_back(to_json(structure));
    for (const auto& [id, contour] : project_.state().contours) contours.push_back(told(*contour));
    for (const auto& [id, surface] : surfaces_.all())
        if (project_.state().structures.contains(id)) surfaces.push_back(surface_event(*surface));
    const Grid& grid = image_->grid;
    const ViewNames names = view_names(grid);
    json event{{"event", "session"},
               {"version", KONTUR_VERSION},
               {"title", title_},
               {"project", project_.path().filename().string()},
               {"read_only", project_.is_read_only()},
               {"image",
                {{"size", {grid.size.i, grid.size.j, grid.size.k}},
                 {"spacing_mm", to_json(grid.spacing_mm())},
                 {"corners", corners_json(grid)},
                 {"center", to_json(grid.bounds_mm().center())},
                 {"unit", unit()},
                 {"range", {range_.first, range_.second}},
                 {"times", times_.count()},
                 {"time", times_.own()},
                 {"notes", notes_}}},
               {"identity", to_json(identity_)},
               {"images", further_images()},
               {"has_dicom", series_.has_value()},
               {"window", {{"center", window_.center}, {"width", window_.width}}},
               {"presets", to_json(presets_)},
               {"views", views_json(grid, names)},
               {"first_view", kViews[static_cast<std::size_t>(names.first)]},
               {"structures", structures},
               {"contours", contours},
               {"surfaces", surfaces},
               {"borders", to_json(project_.state().borders)},
               {"use_image", use_image()},
               {"border_pairs", borders_found(surfaces_.border_pairs())},
               {"history", history()},
               {"imports", {{"contours", kContourEndings}, {"masks", kMaskEndings}}},
               {"page", page_state()}};
    event.update(more);
    return to_text(event);
}

std::string Session::modality() const {
    if (identity_.modality.empty() && looks_like_ct(*image_)) return "CT";
    return identity_.modality;
}

/// A project may come from anywhere: what `page.save` would have refused is not given back.
json Session::page_state() {
    const std::string stored = project_.page_state();
    if (stored.size() > kLargestPageState) return nullptr;
    try {
        return parsed(stored);
    } catch (const json::exception&) {
        return nullptr;
    } catch (const Error&) {
        return nullptr;
    }
}

json Session::save_page(const Members& m) {
    const std::string state = to_text(m.at("state"));
    if (state.size() > kLargestPageState)
        throw Error(ErrorKind::too_large,
                    fmt::format("'state' has {} bytes; the limit is {}", state.size(), kLargestPageState));
    project_.save_page_state(state);
    return json::object();
}

json Session::surface_event(const Surface& surface) const {
    json event{{"event", "surface"},
               {"structure", surface.structure},
               {"revision", surface.revision},
               {"stage", std::string(name(surface.stage))},
               {"triangles", surface.mesh ? surface.mesh->triangles.size() : 0},
               {"warnings", surface.warnings}};
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
    if (!has_full_resolution(surface.stage)) return event;
    if (surface.image.verdict != ImageVerdict::none)
        event["image"] = {{"verdict", std::string(name(surface.image.verdict))}, {"text", sentence(surface.image)}};
    event["volume_ml"] = surface.volume_ml;
    event["residual"] = {{"max_mm", surface.residual.max_mm},
                         {"rms_mm", surface.residual.rms_mm},
                         {"contour", surface.worst_contour},
                         {"at", to_json(surface.worst_at)}};
    event["uncertainty"] = to_json(surface_uncertainty(evidence_of(surface)));
    return event;
}

json Session::history() {
    const auto label = [](const std::optional<std::string>& text) { return text ? json(*text) : json(nullptr); };
    return {{"undo", label(project_.undo_label())}, {"redo", label(project_.redo_label())}};
}

}  // namespace kontur::viewer
