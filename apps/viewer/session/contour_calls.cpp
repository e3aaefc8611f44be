// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "viewer/edits/contour_edits.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/events.h"
#include "viewer/session/history.h"
#include "viewer/session/page_json.h"
#include "viewer/session/reviews.h"

// Calls that draw contours and change them.

namespace kontur::viewer {
namespace {

using nlohmann::json;

double snap_radius_mm(const Members& m) {
    // Eight screen pixels are what a hand aims with.
    return m.has("mm_per_pixel") ? 8 * std::clamp(m.number("mm_per_pixel"), 1e-3, 100.0) : SketchOptions{}.snap_radius_mm;
}

SketchPoint sketch_point(const json& item) {
    const Members m(item);
    SketchPoint point{m.point("at"), m.stretch("kind"), {}, m.image("image")};
    if (!m.has("path")) return point;
    std::vector<Vec3> line = m.points("path");
    line.insert(line.begin(), point.at);
    line = thinned(line);
    point.path.emplace(line.begin() + 1, line.end());
    return point;
}

std::vector<SketchPoint> sketch_from(const Members& m) {
    std::vector<SketchPoint> sketch;
    for (const json& item : m.at("control")) sketch.push_back(sketch_point(item));
    return sketch;
}

std::vector<Id> ids_from(const Members& m) {
    std::set<Id> ids;
    for (const json& item : m.at("ids")) ids.insert(item.get<Id>());
    return {ids.begin(), ids.end()};
}

/// What the history calls a new contour.
std::string label_of(std::string_view origin) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 5> kOrigins{{{"drawn", "Draw a contour"},
                                                                                       {"pulled", "Pull the outline"},
                                                                                       {"pushed", "Push the outline"},
                                                                                       {"adopted", "Keep the outline"},
                                                                                       {"proposed", "Accept the proposal"}}};
    return std::ranges::find(kOrigins, origin, &std::pair<std::string_view, const char*>::first)->second;
}

/// What the message says of the contour beside its line. `structure` has been checked.
void set_marks(DrawnContour& contour, const Members& m) {
    if (m.has("structure")) contour.structure = m.id("structure");
    contour.hole = m.flag_or("hole", contour.hole);
    contour.visible = m.flag_or("visible", contour.visible);
    if (contour.hole && !contour.closed)
        throw Error(ErrorKind::invalid_input, "an open line encloses nothing, so it can be no hole");
    if (m.has("weight")) contour.weight = m.weight("weight");
    if (m.has("end")) contour.end = m.end("end");
    if (contour.hole || !contour.closed) {
        if (m.has("end") && contour.end != ContourEnd::automatic)
            throw Error(ErrorKind::invalid_input, "a structure ends at closed contours that are no holes");
        contour.end = ContourEnd::automatic;
    }
    if (!m.has("inside")) return;
    if (contour.closed)
        throw Error(ErrorKind::invalid_input,
                    "the structure lies inside of a closed contour; of open lines alone the side is told");
    contour.inside.reset();
    if (m.text("inside", 16) != "auto") contour.inside = m.hand("inside");
}

/// The line closed or opened, if the message says so, and its marks set.
DrawnContour with_changes(const DrawnContour& before, const Members& m, SliceEdges& edges) {
    std::optional<Vec3> at;
    if (m.has("at")) at = m.point("at");
    DrawnContour after = before;
    if (m.has("closed")) after = m.flag("closed") ? closed(before, edges) : opened(before, at, edges);
    set_marks(after, m);
    return after;
}

/// What the history calls such a change of one contour.
const char* label_of_marks(const Members& m) {
    if (m.has("closed")) return m.flag("closed") ? "Close a line" : "Open a contour";
    if (m.has("inside")) return "Tell the side of a line";
    if (m.has("end")) return "End at a contour";
    if (m.has("weight")) return "Weight of a contour";
    return m.has("visible") ? "Show or hide a contour" : "Change a contour";
}

Commit one_contour(const std::string& label, const State& state, const DrawnContour& after) {
    Change<DrawnContour> change{after.id, {}, after};
    if (const auto before = state.contours.find(after.id); before != state.contours.end()) change.before = *before->second;
    return {label, {}, {change}};
}

json path(SessionState& s, const Members& m) {
    const Members plane(m.at("plane"));
    SketchOptions options;
    options.closed = m.flag_or("closed", false);
    options.snap = m.flag_or("snap", true);
    options.snap_radius_mm = snap_radius_mm(plane);
    const auto edges = s.edges.at(m.time().value_or(s.image.times.own()));
    const PlacedSketch drawing = draw(sketch_from(m), m.plane("plane"), *edges, options);
    json control = json::array();
    for (const ControlPoint& c : drawing.control) control.push_back(to_json(c));
    return {{"points", to_json(drawing.points)}, {"control", std::move(control)}};
}

/// A line that cannot correct its structure's mask is refused before it is a step of the history.
void check_correction(SessionState& s, const DrawnContour& contour) {
    check_time(s, structure_of(s.project.state(), contour.structure), contour);
    const auto mask = mask_of(s.project.state(), structure_of(s.project.state(), contour.structure));
    if (!mask) return;
    ContourSet plane;
    for (const auto& [id, other] : s.project.state().contours)
        if (id != contour.id && other->structure == contour.structure && is_same_plane(other->plane, contour.plane))
            plane.contours.push_back(as_contour(*other));
    plane.contours.push_back(as_contour(contour));
    s.surfaces.check_correction(contour.structure, mask, std::move(plane));
}

/// What was said of the whole plane of a correction, empty or right, holds no longer.
void forget_plane(const SessionState& s, const DrawnContour& contour, Commit& step) {
    const Structure& before = structure_of(s.project.state(), contour.structure);
    if (!before.mask) return;
    Structure after = before;
    const auto is_its = [&](const Plane& plane) { return is_same_plane(plane, contour.plane); };
    if (std::erase_if(after.empty_planes, is_its) + std::erase_if(after.mask->confirmed_planes, is_its) > 0)
        step.structures.push_back({after.id, before, after});
}

/// Stores a new or changed contour, or only shows it when the call is a draft.
json put(SessionState& s, const std::string& label, DrawnContour contour, const Members& m) {
    check_is_drawn(s.project.state(), contour.structure);
    if (m.flag_or("draft", false)) check_is_unlocked(structure_of(s.project.state(), contour.structure));
    std::vector<DrawnContour> carried = carried_with(s, contour);
    json result{{"contour", PageJson()(contour)}, {"carried", json::array()}};
    for (const DrawnContour& other : carried) result["carried"].push_back(PageJson()(other));
    if (m.flag_or("draft", false)) {
        std::set<Id> touched = drafted(s);
        s.draft = Draft{std::move(contour), std::move(carried), s.caller};
        touched.merge(drafted(s));
        for (const Id id : touched) follow(s, id);
        return result;
    }
    check_correction(s, contour);
    if (contour.id == 0) result["contour"]["id"] = contour.id = s.project.new_id();
    Commit step = one_contour(label, s.project.state(), contour);
    for (DrawnContour& other : carried)
        step.contours.push_back({other.id, contour_of(s.project.state(), other.id), std::move(other)});
    forget_plane(s, contour, step);
    if (step.structures.empty()) commit_ahead(s, step);
    else commit(s, step);
    return result;
}

json add_contour(SessionState& s, const Members& m) {
    SketchOptions options;
    // The page sends control points that `path` has snapped already.
    options.snap = false;
    options.closed = m.flag_or("closed", true);
    const Plane plane = m.plane("plane");  // of two wrong members every compiler's program names the same
    const std::optional<int> time = time_from(s, m.time());
    const auto edges = s.edges.at(time.value_or(s.image.times.own()));
    DrawnContour contour = draw_contour(sketch_from(m), plane, *edges, options);
    contour.time = time;
    contour.structure = structure_of(s.project.state(), m.id("structure")).id;
    set_marks(contour, m);
    return put(s, label_of(m.has("origin") ? m.text("origin", 16) : "drawn"), std::move(contour), m);
}

json move_control_point(SessionState& s, const Members& m) {
    SketchOptions options;
    options.snap_radius_mm = snap_radius_mm(m);
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    const auto index = static_cast<std::size_t>(m.integer("index", 0, kMostPoints));
    return put(s, "Move a point", move_point(contour, index, m.point("to"), *s.edges_of(contour), options), m);
}

json insert_control_point(SessionState& s, const Members& m) {
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    return put(s, "Insert a point", insert_point(contour, m.point("at"), *s.edges_of(contour)), m);
}

json delete_control_point(SessionState& s, const Members& m) {
    const auto index = static_cast<std::size_t>(m.integer("index", 0, kMostPoints));
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    return put(s, "Delete a point", delete_point(contour, index, *s.edges_of(contour)), m);
}

json pull_contour(SessionState& s, const Members& m) {
    std::optional<double> radius;
    if (m.has("radius_mm")) radius = m.number("radius_mm");
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    return put(s, "Bend a contour", pull(contour, m.point("from"), m.point("to"), radius, *s.edges_of(contour)), m);
}

json redraw_contour(SessionState& s, const Members& m) {
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    const auto edges = s.edges_of(contour);
    const std::vector<Vec3> path = m.points("path");
    const bool whole = m.flag_or("whole", false);
    const bool is_pushed = m.has("origin") && m.text("origin", 16) == "pushed";
    return put(s, is_pushed ? "Push a contour" : "Redraw a part",
               whole ? redraw_whole(contour, path, *edges) : redraw(contour, path, *edges), m);
}

json translate_contour(SessionState& s, const Members& m) {
    return put(s, "Move a contour", translate(contour_of(s.project.state(), m.id("id")), m.point("by")), m);
}

json copy_contour(SessionState& s, const Members& m) {
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    double offset_mm = 0;
    if (m.has("plane")) {
        const Plane target = m.plane("plane");
        if (std::abs(dot(target.normal, contour.plane.normal)) < 1 - 1e-6)
            throw Error(ErrorKind::invalid_input, "a contour can only be copied to a parallel slice");
        offset_mm = contour.plane.distance_to(target.origin);
    } else {
        offset_mm = m.number("offset_mm");
    }
    DrawnContour copy = offset(contour, offset_mm);
    copy.id = 0;
    if (m.has("time")) copy.time = time_from(s, m.time());
    return put(s, "Copy a contour", std::move(copy), m);
}

json set_contours(SessionState& s, const Members& m) {
    Commit changed;
    if (m.has("structure")) structure_of(s.project.state(), m.id("structure"));
    for (const Id id : ids_from(m)) {
        const DrawnContour& before = contour_of(s.project.state(), id);
        changed.contours.push_back({id, before, with_changes(before, m, *s.edges_of(before))});
    }
    changed.label =
        fmt::format("{} {}", m.has("visible") ? "Show or hide" : "Change", counted(changed.contours.size(), "contour"));
    commit(s, changed);
    return json::object();
}

/// One contour, or several as one step.
json set_contour(SessionState& s, const Members& m) {
    if (m.has("ids")) return set_contours(s, m);
    if (m.has("structure")) structure_of(s.project.state(), m.id("structure"));
    const DrawnContour& contour = contour_of(s.project.state(), m.id("id"));
    return put(s, label_of_marks(m), with_changes(contour, m, *s.edges_of(contour)), m);
}

json remove_contours(SessionState& s, const Members& m) {
    Commit removed;
    for (const Id id : ids_from(m)) removed.contours.push_back({id, contour_of(s.project.state(), id), {}});
    removed.label =
        removed.contours.size() == 1 ? "Delete a contour" : fmt::format("Delete {} contours", removed.contours.size());
    commit(s, removed);
    return json::object();
}

}  // namespace

Calls contour_calls() {
    return {{"path", {path, false}},
            {"contour.add", {add_contour}},
            {"contour.move_point", {move_control_point}},
            {"contour.insert_point", {insert_control_point}},
            {"contour.delete_point", {delete_control_point}},
            {"contour.pull", {pull_contour}},
            {"contour.redraw", {redraw_contour}},
            {"contour.translate", {translate_contour}},
            {"contour.copy", {copy_contour}},
            {"contour.set", {set_contour}},
            {"contour.remove", {remove_contours}}};
}

}  // namespace kontur::viewer
