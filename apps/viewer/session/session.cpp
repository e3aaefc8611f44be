// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "kontur/base/error.h"
#include "kontur/image/intensities.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

json error_json(std::string_view kind, std::string_view message) {
    return {{"kind", std::string(kind)}, {"message", std::string(message)}};
}

}  // namespace

std::string notice_event(std::string_view level, const std::string& text) {
    return to_text({{"event", "notice"}, {"level", std::string(level)}, {"text", text}});
}

Session::Session(OpenedImage opened, const std::filesystem::path& project)
    : image_(std::move(opened.image)),
      times_(image_, std::move(opened.times)),
      title_(std::move(opened.title)),
      frame_of_reference_uid_(std::move(opened.frame_of_reference_uid)),
      series_(std::move(opened.series)),
      identity_(std::move(opened.identity)),
      mm_to_index_(image_->grid.index_to_mm.inverse()),
      presets_(window_presets(*image_)),
      window_(suggest_window(*image_)),
      range_(value_range(*image_)),
      shows_borders_(range_.first < range_.second && !is_label_map(*image_)),
      edges_(image_),
      fits_(image_),
      notes_(std::move(opened.notes)),
      project_(project, opened.reference),
      surfaces_(
          {[this](Id structure, std::int64_t revision, const PlaneCutters& cut) { tell_outlines(structure, revision, cut); },
           [this](const std::shared_ptr<const Surface>& surface) { tell(surface_event(*surface)); },
           [this](const std::string& text, std::optional<double> fraction) { tell_status(text, fraction); },
           [this](const std::vector<BorderPair>& pairs, const std::string& problem) { tell_borders(pairs, problem); }}) {
    if (const ImageReference& known = project_.image(); known.fingerprint != opened.reference.fingerprint)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} was drawn on another image ({}) than {}", project.string(), known.path, title_));
    if (project_.is_read_only())
        notes_.push_back(
            fmt::format("{} can only be read here, so nothing can be drawn or changed. To go on from it save a "
                        "copy where you can write: Export, Project.",
                        project.filename().string()));
    else if (project_.image().path != opened.reference.path || project_.image().choice != opened.reference.choice)
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

const Structure& Session::structure_asked_for(const State& now, Id id) const {
    const std::scoped_lock lock(mutex_);
    if (!now.structures.contains(id) && project_.has_given(id))
        throw StructureRemoved(ErrorKind::invalid_input, fmt::format("the structure with the id {} has been removed", id));
    return structure_of(now, id);
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
        check_message(request, *call_types().find(found->first)->second, {"seq", "call"});
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
        {"point.add", {&Session::add_single_point}},
        {"point.move", {&Session::move_single_point}},
        {"point.set", {&Session::set_single_point}},
        {"point.remove", {&Session::remove_single_point}},
        {"image.set", {&Session::set_image}},
        {"image.remove", {&Session::remove_image}},
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

json Session::ping(const Members&) { return json::object(); }

}  // namespace kontur::viewer
