// SPDX-License-Identifier: Apache-2.0
#include "viewer/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

#include "kontur/base/error.h"
#include "kontur/refine/intensities.h"
#include "kontur/refine/surface_uncertainty.h"
#include "viewer/contour_edits.h"
#include "viewer/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

constexpr std::size_t kMostControlPoints = 10'000;
constexpr std::size_t kLongestName = 100;
constexpr std::size_t kMostPointsOfProject = 2'000'000;  ///< of imports: a page is told all of them at once
constexpr std::size_t kLargestPageState = 64 << 10;
constexpr std::size_t kMostCheckedPoints = 100'000;  ///< for crossings, at some microseconds each

/// Told apart by people with any colour vision, on a dark ground (Okabe and Ito's palette, the dark ones left out).
constexpr std::array kColors{"#e69f00", "#56b4e9", "#009e73", "#f0e442", "#d55e00", "#cc79a7"};

json error_json(std::string_view kind, std::string_view message) {
    return {{"kind", std::string(kind)}, {"message", std::string(message)}};
}

double snap_radius_mm(const Members& m) {
    // Eight screen pixels are what a hand aims with.
    return m.has("mm_per_pixel") ? 8 * std::clamp(m.number("mm_per_pixel"), 1e-3, 100.0) : SketchOptions{}.snap_radius_mm;
}

SketchPoint sketch_point(const json& item) {
    const Members m(item);
    SketchPoint point{m.point("at"), m.stretch("kind"), {}};
    if (!m.has("path")) return point;
    std::vector<Vec3> line = m.points("path");
    line.insert(line.begin(), point.at);
    line = thinned(line, 0.1);
    point.path.emplace(line.begin() + 1, line.end());
    return point;
}

std::vector<SketchPoint> sketch_from(const Members& m) {
    const json& array = m.at("control");
    if (!array.is_array() || array.empty() || array.size() > kMostControlPoints)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("'control' is no array of 1 to {} control points", kMostControlPoints));
    std::vector<SketchPoint> sketch;
    for (const json& item : array) sketch.push_back(sketch_point(item));
    return sketch;
}

std::vector<Id> ids_from(const Members& m) {
    const json& array = m.at("ids");
    if (!array.is_array()) throw Error(ErrorKind::invalid_input, "'ids' is no array");
    std::set<Id> ids;
    for (const json& item : array) ids.insert(Members(json{{"ids", item}}).id("ids"));
    return {ids.begin(), ids.end()};
}

/// What the history calls a new contour.
std::string label_of(std::string_view origin) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 4> kOrigins{{{"drawn", "Draw a contour"},
                                                                                       {"pulled", "Pull the outline"},
                                                                                       {"adopted", "Keep the outline"},
                                                                                       {"proposed", "Accept the proposal"}}};
    for (const auto& [name, label] : kOrigins)
        if (name == origin) return label;
    throw Error(ErrorKind::invalid_input,
                fmt::format("'origin' is {}; it must be drawn, pulled, adopted or proposed", origin));
}

Commit one_contour(const std::string& label, const State& state, const DrawnContour& after) {
    Change<DrawnContour> change{after.id, {}, after};
    if (const auto before = state.contours.find(after.id); before != state.contours.end()) change.before = *before->second;
    return {label, {}, {change}};
}

Change<DrawnContour> removal(const DrawnContour& contour) { return {contour.id, contour, {}}; }

/// Objects as pages are told of them: with what they show and no project need store. For one message, which must not take
/// seconds where a project holds millions of points: beyond `kMostCheckedPoints` contours count as crossing themselves
/// nowhere.
class Told {
public:
    json operator()(const Structure& structure) { return to_json(structure); }
    json operator()(const DrawnContour& contour) {
        points_ += contour.points.size();
        json told = to_json(contour);
        told["self_crossings"] = points_ <= kMostCheckedPoints ? to_json(self_crossings(contour)) : json::array();
        return told;
    }

private:
    std::size_t points_ = 0;
};

template <class Row>
json changes_json(const std::vector<Change<Row>>& changes) {
    json set = json::array(), removed = json::array();
    Told told;
    for (const Change<Row>& change : changes) {
        if (change.after) set.push_back(told(*change.after));
        else removed.push_back(change.id);
    }
    return {{"set", std::move(set)}, {"removed", std::move(removed)}};
}

json view_json(const View& view) {
    return {{"plane", to_json(view.plane)},
            {"step_mm", view.step_mm},
            {"width_mm", view.width_mm},
            {"height_mm", view.height_mm},
            {"range_mm", {view.from_mm, view.to_mm}}};
}

json views_json(const Grid& grid) {
    return {{"axial", view_json(view_of(grid, SliceKind::axial))},
            {"sagittal", view_json(view_of(grid, SliceKind::sagittal))},
            {"coronal", view_json(view_of(grid, SliceKind::coronal))},
            {"oblique", view_json(oblique_view(grid))}};
}

json corners_json(const Grid& grid) {
    json corners = json::array();
    for (const Vec3& corner : outer_corners(grid)) corners.push_back(to_json(corner));
    return corners;
}

json identity_json(const DicomIdentity& identity) {
    return {{"patient_name", identity.patient_name},
            {"patient_id", identity.patient_id},
            {"birth_date", identity.birth_date},
            {"study_date", identity.study_date},
            {"study_description", identity.study_description},
            {"series_number", identity.series_number},
            {"series_description", identity.series_description},
            {"modality", identity.modality}};
}

/// Whether both ask the same of the surface.
bool same_surface(const DrawnContour& a, const DrawnContour& b) {
    return a.points == b.points && a.plane == b.plane && a.hole == b.hole && a.structure == b.structure;
}

/// A file's name for a structure: whole characters of UTF-8.
std::string name_from(const std::string& text) {
    std::string name = parsed(to_text(text)).get<std::string>();
    if (name.size() <= kLongestName) return name;
    std::size_t end = kLongestName;
    while (end > 0 && (name[end] & 0xc0) == 0x80) --end;
    return name.substr(0, end);
}

std::string free_name(const State& state) {
    for (std::size_t number = state.structures.size() + 1;; ++number) {
        std::string name = fmt::format("Structure {}", number);
        const bool taken = std::any_of(state.structures.begin(), state.structures.end(),
                                       [&](const auto& item) { return item.second.name == name; });
        if (!taken) return name;
    }
}

std::string next_color(const State& state) {
    std::array<int, kColors.size()> uses{};
    for (const auto& [id, structure] : state.structures)
        for (std::size_t i = 0; i < kColors.size(); ++i) uses[i] += structure.color == kColors[i];
    return kColors[static_cast<std::size_t>(std::min_element(uses.begin(), uses.end()) - uses.begin())];
}

}  // namespace

std::string notice_event(std::string_view level, const std::string& text) {
    return to_text({{"event", "notice"}, {"level", std::string(level)}, {"text", text}});
}

Session::Session(OpenedImage opened, const std::filesystem::path& project)
    : image_(std::move(opened.image)),
      title_(std::move(opened.title)),
      notes_(std::move(opened.notes)),
      frame_of_reference_uid_(std::move(opened.frame_of_reference_uid)),
      series_(std::move(opened.series)),
      identity_(std::move(opened.identity)),
      mm_to_index_(image_->grid.index_to_mm.inverse()),
      presets_(window_presets(*image_)),
      window_(suggest_window(*image_)),
      range_(value_range(*image_)),
      shows_borders_(range_.first < range_.second && !is_label_map(*image_)),
      edges_(image_),
      project_(project, opened.reference),
      surfaces_(
          {[this](Id structure, std::int64_t revision, const PlaneCutters& cut) { tell_outlines(structure, revision, cut); },
           [this](const std::shared_ptr<const Surface>& surface) { tell(surface_event(*surface)); },
           [this](const std::string& text, std::optional<double> fraction) { tell_status(text, fraction); },
           [this](const std::vector<BorderPair>& pairs, const std::string& problem) { tell_borders(pairs, problem); }}) {
    if (const ImageReference& known = project_.image(); known.fingerprint != opened.reference.fingerprint)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} was drawn on another image ({}) than {}", project.string(), known.path, title_));
    if (project_.image().path != opened.reference.path || project_.image().choice != opened.reference.choice)
        project_.save_image(opened.reference);
    surfaces_.use_image(image_to_ask());
    surfaces_.share_borders(project_.state().borders);
    for (const auto& [id, structure] : project_.state().structures) surfaces_.follow_later(surface_task(id));
}

Session::~Session() = default;

std::string Session::image_path() const {
    const std::scoped_lock lock(mutex_);
    return project_.image().path;
}

State Session::state() const {
    const std::scoped_lock lock(mutex_);
    return project_.state();
}

void Session::on_event(std::function<void(const std::string&)> listener) {
    const std::scoped_lock lock(listener_mutex_);
    listener_ = std::move(listener);
}

void Session::tell(const json& event) {
    const std::scoped_lock lock(listener_mutex_);
    if (listener_) listener_(to_text(event));
}

void Session::tell_status(const std::string& text, std::optional<double> fraction) {
    tell({{"event", "status"}, {"text", text}, {"fraction", fraction ? json(*fraction) : json(nullptr)}});
}

void Session::notice(std::string_view level, const std::string& text) {
    const std::scoped_lock lock(listener_mutex_);
    if (listener_) listener_(notice_event(level, text));
}

std::string Session::greeting(const json& more) {
    const std::scoped_lock lock(mutex_);
    json structures = json::array(), contours = json::array(), surfaces = json::array(), presets = json::array();
    Told told;
    for (const auto& [id, structure] : project_.state().structures) structures.push_back(to_json(structure));
    for (const auto& [id, contour] : project_.state().contours) contours.push_back(told(*contour));
    for (const auto& [id, surface] : surfaces_.all())
        if (project_.state().structures.contains(id)) surfaces.push_back(surface_event(*surface));
    for (const WindowPreset& preset : presets_)
        presets.push_back({{"name", preset.name}, {"center", preset.window.center}, {"width", preset.window.width}});
    const Grid& grid = image_->grid;
    json event{{"event", "session"},
               {"version", KONTUR_VERSION},
               {"title", title_},
               {"project", project_.path().filename().string()},
               {"image",
                {{"size", {grid.size.i, grid.size.j, grid.size.k}},
                 {"spacing_mm", to_json(grid.spacing_mm())},
                 {"corners", corners_json(grid)},
                 {"center", to_json(grid.bounds_mm().center())},
                 {"unit", unit()},
                 {"range", {range_.first, range_.second}},
                 {"notes", notes_}}},
               {"identity", identity_json(identity_)},
               {"has_dicom", series_.has_value()},
               {"window", {{"center", window_.center}, {"width", window_.width}}},
               {"presets", presets},
               {"views", views_json(grid)},
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

std::string Session::unit() const {
    if (!identity_.modality.empty()) return identity_.unit;
    return looks_like_ct(*image_) ? "HU" : "";
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

json Session::surface_event(const Surface& surface) const {
    json event{{"event", "surface"},
               {"structure", surface.structure},
               {"revision", surface.revision},
               {"stage", std::string(name(surface.stage))},
               {"triangles", surface.mesh ? surface.mesh->triangles.size() : 0},
               {"warnings", surface.warnings}};
    if (is_finished(surface.stage) || surface.stage == SurfaceStage::none) {
        event["conflicts"] = json::array();
        for (const Conflict& conflict : surface.conflicts)
            event["conflicts"].push_back({{"at", to_json(conflict.at)},
                                          {"distance_mm", conflict.disagreement_mm},
                                          {"contours", {conflict.contour, conflict.other}}});
    }
    if (!is_finished(surface.stage)) return event;
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

std::string Session::call(std::string_view message, PageId page) {
    json seq = nullptr;
    const auto failed = [&](std::string_view kind, std::string_view sentence) {
        return to_text({{"seq", seq}, {"error", error_json(kind, sentence)}});
    };
    try {
        const json request = parsed(message);
        const Members m(request);
        if (m.has("seq") && m.at("seq").is_number_integer()) seq = m.at("seq");
        const auto found = calls().find(m.text("call", 64));
        if (found == calls().end())
            return failed(name(ErrorKind::invalid_input), fmt::format("there is no call '{}'", m.text("call", 64)));
        std::unique_lock lock(mutex_, std::defer_lock);
        if (found->second.needs_project) {
            lock.lock();
            caller_ = page;
        }
        return to_text({{"seq", seq}, {"result", (this->*found->second.method)(m)}});
    } catch (const json::exception&) {
        return failed(name(ErrorKind::invalid_input), "the message is no JSON that kontur understands");
    } catch (const Error& error) {
        return failed(name(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        return failed(name(ErrorKind::too_large), "there is not enough memory for this");
    } catch (const std::exception& error) {
        return failed("internal", error.what());
    }
}

void Session::left(PageId page) {
    const std::scoped_lock lock(mutex_);
    if (!draft_ || draft_owner_ != page) return;
    try {
        clear_draft();
    } catch (const std::exception& error) {
        notice("error", error.what());
    }
}

const std::map<std::string, Session::Call, std::less<>>& Session::calls() {
    static const std::map<std::string, Call, std::less<>> table{
        {"path", {&Session::path, false}},
        {"outline", {&Session::outline_of, false}},
        {"suggest", {&Session::suggest, false}},
        {"contour.add", {&Session::add_contour}},
        {"contour.move_point", {&Session::move_control_point}},
        {"contour.insert_point", {&Session::insert_control_point}},
        {"contour.delete_point", {&Session::delete_control_point}},
        {"contour.pull", {&Session::pull_contour}},
        {"contour.redraw", {&Session::redraw_contour}},
        {"contour.translate", {&Session::translate_contour}},
        {"contour.copy", {&Session::copy_contour}},
        {"contour.set", {&Session::set_contour}},
        {"contour.remove", {&Session::remove_contours}},
        {"structure.add", {&Session::add_structure}},
        {"structure.set", {&Session::set_structure}},
        {"structure.remove", {&Session::remove_structure}},
        {"image.set", {&Session::set_image}},
        {"borders.set", {&Session::set_borders}},
        {"borders.rule", {&Session::set_border_rule}},
        {"draft.drop", {&Session::drop_draft}},
        {"undo", {&Session::undo}},
        {"redo", {&Session::redo}},
        {"value", {&Session::value, false}},
        {"page.save", {&Session::save_page}},
        {"ping", {&Session::ping, false}},
    };
    return table;
}

json Session::path(const Members& m) {
    const Members plane(m.at("plane"));
    SketchOptions options;
    options.closed = m.flag_or("closed", false);
    options.snap = m.flag_or("snap", true);
    options.snap_radius_mm = snap_radius_mm(plane);
    const Drawing drawing = draw(sketch_from(m), m.plane("plane"), edges_, options);
    json control = json::array();
    for (const ControlPoint& c : drawing.control) control.push_back(to_json(c));
    return {{"points", to_json(drawing.points)}, {"control", std::move(control)}};
}

json Session::put(const std::string& label, DrawnContour contour, const Members& m) {
    std::vector<DrawnContour> carried = carried_with(contour);
    json result{{"contour", Told()(contour)}, {"carried", json::array()}};
    for (const DrawnContour& other : carried) result["carried"].push_back(Told()(other));
    if (m.flag_or("draft", false)) {
        std::set<Id> touched = drafted();
        draft_ = std::move(contour);
        carried_ = std::move(carried);
        draft_owner_ = caller_;
        touched.merge(drafted());
        for (const Id id : touched) follow(id);
        return result;
    }
    if (contour.id == 0) result["contour"]["id"] = contour.id = project_.new_id();
    Commit step = one_contour(label, project_.state(), contour);
    for (DrawnContour& other : carried)
        step.contours.push_back({other.id, contour_of(project_.state(), other.id), std::move(other)});
    commit_ahead(step);
    return result;
}

json Session::add_contour(const Members& m) {
    SketchOptions options;
    // The page sends control points that `path` has snapped already.
    options.snap = false;
    const Plane plane = m.plane("plane");  // of two wrong members every compiler's program names the same
    DrawnContour contour = draw_contour(sketch_from(m), plane, edges_, options);
    contour.structure = structure_of(project_.state(), m.id("structure")).id;
    contour.hole = m.flag_or("hole", false);
    return put(label_of(m.has("origin") ? m.text("origin", 16) : "drawn"), std::move(contour), m);
}

json Session::move_control_point(const Members& m) {
    SketchOptions options;
    options.snap_radius_mm = snap_radius_mm(m);
    const DrawnContour& contour = contour_of(project_.state(), m.id("id"));
    const auto index = static_cast<std::size_t>(m.integer("index", 0, kMostPoints));
    return put("Move a point", move_point(contour, index, m.point("to"), edges_, options), m);
}

json Session::insert_control_point(const Members& m) {
    return put("Insert a point", insert_point(contour_of(project_.state(), m.id("id")), m.point("at"), edges_), m);
}

json Session::delete_control_point(const Members& m) {
    const auto index = static_cast<std::size_t>(m.integer("index", 0, kMostPoints));
    return put("Delete a point", delete_point(contour_of(project_.state(), m.id("id")), index, edges_), m);
}

json Session::pull_contour(const Members& m) {
    std::optional<double> radius;
    if (m.has("radius_mm")) radius = m.number("radius_mm");
    return put("Bend a contour",
               pull(contour_of(project_.state(), m.id("id")), m.point("from"), m.point("to"), radius, edges_), m);
}

json Session::redraw_contour(const Members& m) {
    const DrawnContour& contour = contour_of(project_.state(), m.id("id"));
    const std::vector<Vec3> path = m.points("path");
    const bool whole = m.flag_or("whole", false);
    return put("Redraw a part", whole ? redraw_whole(contour, path, edges_) : redraw(contour, path, edges_), m);
}

json Session::translate_contour(const Members& m) {
    return put("Move a contour", translate(contour_of(project_.state(), m.id("id")), m.point("by")), m);
}

json Session::copy_contour(const Members& m) {
    const DrawnContour& contour = contour_of(project_.state(), m.id("id"));
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
    return put("Copy a contour", std::move(copy), m);
}

/// One contour, or several as one step.
json Session::set_contour(const Members& m) {
    if (m.has("ids")) return set_contours(m);
    DrawnContour contour = contour_of(project_.state(), m.id("id"));
    if (m.has("structure")) contour.structure = structure_of(project_.state(), m.id("structure")).id;
    contour.hole = m.flag_or("hole", contour.hole);
    contour.visible = m.flag_or("visible", contour.visible);
    return put(m.has("visible") ? "Show or hide a contour" : "Change a contour", std::move(contour), m);
}

json Session::set_contours(const Members& m) {
    Commit changed;
    for (const Id id : ids_from(m)) {
        const DrawnContour& before = contour_of(project_.state(), id);
        DrawnContour after = before;
        if (m.has("structure")) after.structure = structure_of(project_.state(), m.id("structure")).id;
        after.hole = m.flag_or("hole", before.hole);
        after.visible = m.flag_or("visible", before.visible);
        changed.contours.push_back({id, before, std::move(after)});
    }
    changed.label = fmt::format("{} {} contours", m.has("visible") ? "Show or hide" : "Change", changed.contours.size());
    commit(changed);
    return json::object();
}

json Session::remove_contours(const Members& m) {
    Commit removed;
    for (const Id id : ids_from(m)) removed.contours.push_back(removal(contour_of(project_.state(), id)));
    removed.label =
        removed.contours.size() == 1 ? "Delete a contour" : fmt::format("Delete {} contours", removed.contours.size());
    commit(removed);
    return json::object();
}

json Session::add_structure(const Members& m) {
    Structure structure;
    structure.name = m.has("name") ? m.text("name", kLongestName) : free_name(project_.state());
    structure.color = m.has("color") ? m.color("color") : next_color(project_.state());
    structure.id = project_.new_id();
    commit({"Add " + structure.name, {{structure.id, {}, structure}}, {}});
    return {{"structure", to_json(structure)}};
}

json Session::set_structure(const Members& m) {
    const Structure before = structure_of(project_.state(), m.id("id"));
    Structure after = before;
    if (m.has("name")) after.name = m.text("name", kLongestName);
    if (m.has("color")) after.color = m.color("color");
    after.visible = m.flag_or("visible", after.visible);
    if (m.has("empty_planes")) after.empty_planes = m.planes("empty_planes", kMostEmptyPlanes);
    std::string label = "Show or hide " + after.name;
    if (after.empty_planes != before.empty_planes) label = fmt::format("Nothing of {} in a plane", after.name);
    if (after.empty_planes.size() < before.empty_planes.size()) label = "Forget empty planes of " + after.name;
    if (after.color != before.color) label = "Colour " + after.name;
    if (after.name != before.name) label = "Rename " + before.name;
    commit({label, {{after.id, before, after}}, {}});
    return {{"structure", to_json(after)}};
}

json Session::remove_structure(const Members& m) {
    const Structure structure = structure_of(project_.state(), m.id("id"));
    Commit removed{"Delete " + structure.name, {{structure.id, structure, {}}}, {}};
    for (const auto& [id, contour] : project_.state().contours)
        if (contour->structure == structure.id) removed.contours.push_back(removal(*contour));
    commit(removed);
    return json::object();
}

json Session::drop_draft(const Members&) {
    clear_draft();
    return json::object();
}

json Session::undo(const Members&) {
    clear_draft();
    return moved(project_.undo());
}

json Session::redo(const Members&) {
    clear_draft();
    return moved(project_.redo());
}

json Session::moved(const std::optional<Commit>& step) {
    if (!step) return {{"label", nullptr}};
    announce(*step);
    return {{"label", step->label}};
}

json Session::value(const Members& m) {
    const double value = interpolate(*image_, mm_to_index_, m.point("at"), std::numeric_limits<double>::quiet_NaN());
    return {{"value", std::isfinite(value) ? json(value) : json(nullptr)}};
}

json Session::save_page(const Members& m) {
    const std::string state = to_text(m.at("state"));
    if (state.size() > kLargestPageState)
        throw Error(ErrorKind::too_large,
                    fmt::format("'state' has {} bytes; the limit is {}", state.size(), kLargestPageState));
    project_.save_page_state(state);
    return json::object();
}

json Session::ping(const Members&) { return json::object(); }

Commit Session::new_structures(const std::string& label, const std::vector<ContourSet>& sets) {
    Commit added{label, {}, {}};
    State state = project_.state();
    std::size_t points = 0;
    for (const auto& [id, contour] : state.contours) points += contour->points.size();
    for (const ContourSet& set : sets) {
        Structure structure{project_.new_id(), name_from(set.name), next_color(state), true, set.empty_planes};
        if (structure.name.empty()) structure.name = free_name(state);
        state.structures[structure.id] = structure;
        added.structures.push_back({structure.id, {}, structure});
        for (const Contour& contour : set.contours) {
            points += contour.points.size();
            DrawnContour drawn = as_drawn(contour);
            drawn.id = project_.new_id();
            drawn.structure = structure.id;
            added.contours.push_back({drawn.id, {}, std::move(drawn)});
        }
    }
    if (points > kMostPointsOfProject)
        throw Error(ErrorKind::too_large,
                    fmt::format("the project would hold {} points; the limit is {}", points, kMostPointsOfProject));
    return added;
}

std::vector<Id> Session::add_structures(const std::string& label, const std::vector<ContourSet>& sets) {
    const std::scoped_lock lock(mutex_);
    const Commit added = new_structures(label, sets);
    clear_draft();
    project_.commit(added);
    tell_changes(added);
    std::vector<Id> ids;
    for (const Change<Structure>& change : added.structures) {
        ids.push_back(change.id);
        surfaces_.follow_later(surface_task(change.id));
    }
    return ids;
}

void Session::begin_with(const ContourSet& set) {
    const std::scoped_lock lock(mutex_);
    const Commit first = new_structures({}, {set});
    project_.begin_with(first);
    for (const Change<Structure>& change : first.structures) surfaces_.follow_later(surface_task(change.id));
}

void Session::commit(const Commit& commit) {
    std::set<Id> touched = touched_surfaces(commit);
    touched.merge(drafted());
    draft_.reset();
    carried_.clear();
    try {
        if (!commit.is_empty()) project_.commit(commit);
    } catch (...) {
        for (const Id id : touched) follow(id);
        throw;
    }
    surfaces_.outdate(touched);
    if (!commit.is_empty()) tell_changes(commit);
    follow_touched(commit, touched);
}

void Session::commit_ahead(const Commit& step) {
    const DrawnContour& contour = *step.contours.front().after;
    const bool stays = !step.contours.front().before || step.contours.front().before->structure == contour.structure;
    const bool is_other_draft = draft_ && (draft_->id != contour.id || draft_->structure != contour.structure);
    if (!stays || is_other_draft || step.contours.size() > 1 || !carried_.empty()) return commit(step);
    // What the hand released is most often what it showed last, and then its surface is here already, or on its way.
    const bool is_followed = draft_ ? same_surface(*draft_, contour) : touched_surfaces(step).empty();
    draft_ = contour;
    if (!is_followed) follow(contour.structure);
    try {
        project_.commit(step);
    } catch (...) {
        clear_draft();
        throw;
    }
    draft_.reset();
    tell_changes(step);
}

void Session::tell_changes(const Commit& commit) {
    tell({{"event", "changed"},
          {"structures", changes_json(commit.structures)},
          {"contours", changes_json(commit.contours)},
          {"history", history()},
          {"borders", to_json(project_.state().borders)},
          {"use_image", use_image()}});
    surfaces_.use_image(image_to_ask());
    surfaces_.share_borders(project_.state().borders);
}

void Session::announce(const Commit& commit) {
    const std::set<Id> touched = touched_surfaces(commit);
    surfaces_.outdate(touched);
    tell_changes(commit);
    follow_touched(commit, touched);
}

void Session::follow_touched(const Commit& step, const std::set<Id>& touched) {
    for (const Id id : touched) {
        if (step.use_image) surfaces_.follow_later(surface_task(id));
        else follow(id);
    }
}

std::set<Id> Session::touched_surfaces(const Commit& commit) const {
    std::set<Id> touched;
    if (commit.use_image)
        for (const auto& [id, structure] : project_.state().structures) touched.insert(id);
    for (const auto& change : commit.structures)
        if (!change.before || !change.after || change.before->empty_planes != change.after->empty_planes)
            touched.insert(change.id);
    for (const auto& change : commit.contours) {
        if (change.before && change.after && same_surface(*change.before, *change.after)) continue;
        for (const auto& side : {change.before, change.after})
            if (side) touched.insert(side->structure);
    }
    return touched;
}

SurfaceTask Session::surface_task(Id structure) const {
    SurfaceTask task;
    task.structure = structure;
    const State& state = project_.state();
    if (const auto own = state.structures.find(structure); own != state.structures.end())
        task.set.empty_planes = own->second.empty_planes;
    const auto add = [&](const DrawnContour& contour) {
        if (contour.structure != structure) return;
        task.set.contours.push_back({contour.plane, contour.points, true, contour.hole});
        task.ids.push_back(contour.id);
    };
    // The draft in its contour's place: what is shown of it is then what will be, to the last bit.
    const auto shown = [&](Id id, const DrawnContour& stored) -> const DrawnContour& {
        if (draft_ && draft_->id == id) return *draft_;
        const auto found =
            std::find_if(carried_.begin(), carried_.end(), [&](const DrawnContour& other) { return other.id == id; });
        return found == carried_.end() ? stored : *found;
    };
    for (const auto& [id, contour] : state.contours) add(shown(id, *contour));
    if (draft_ && !state.contours.contains(draft_->id)) add(*draft_);
    if (const auto found = state.structures.find(structure); found != state.structures.end())
        task.set.name = found->second.name;
    return task;
}

void Session::clear_draft() {
    if (!draft_) return;
    const std::set<Id> touched = drafted();
    draft_.reset();
    carried_.clear();
    for (const Id id : touched) follow(id);
}

std::set<Id> Session::drafted() const {
    std::set<Id> structures;
    if (draft_) structures.insert(draft_->structure);
    for (const DrawnContour& other : carried_) structures.insert(other.structure);
    return structures;
}

}  // namespace kontur::viewer
