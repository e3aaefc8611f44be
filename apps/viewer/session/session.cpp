// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session.h"

#include <fmt/format.h>

#include "kontur/image/intensities.h"
#include "viewer/model/message_checks.h"
#include "viewer/model/model_json.h"
#include "viewer/session/calls.h"
#include "viewer/session/history.h"

namespace kontur::viewer {
namespace {

using nlohmann::json;

json error_json(std::string_view kind, std::string_view message) {
    return {{"kind", std::string(kind)}, {"message", std::string(message)}};
}

}  // namespace

const Calls& all_calls() {
    static const Calls table = [] {
        Calls all;
        for (const auto calls :
             {border_calls, contour_calls, history_calls, motion_calls, page_calls, point_calls, review_calls,
              proposal_calls, rule_calls, second_image_calls, structure_calls, use_image_calls})
            all.merge(calls());
        return all;
    }();
    return table;
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
        const auto found = all_calls().find(m.text("call", 64));
        if (found == all_calls().end())
            return failed(name(ErrorKind::invalid_input), fmt::format("there is no call '{}'", m.text("call", 64)));
        check_message(request, *call_types().find(found->first)->second, {"seq", "call"});
        std::unique_lock lock(state_.mutex, std::defer_lock);
        if (found->second.needs_project) {
            lock.lock();
            state_.caller = page;
        }
        return to_text({{"seq", seq}, {"result", found->second.carry_out(state_, m)}});
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
    const std::scoped_lock lock(state_.mutex);
    if (!state_.draft || state_.draft->owner != page) return;
    try {
        clear_draft(state_);
    } catch (const std::exception& error) {
        notice("error", error.what());
    }
}

std::string Session::image_path() const {
    const std::scoped_lock lock(state_.mutex);
    return state_.project.image().path;
}

std::string Session::modality() const {
    const ProjectImage& image = state_.image;
    if (image.identity.modality.empty() && looks_like_ct(*image.voxels)) return "CT";
    return image.identity.modality;
}

std::optional<ImageReference> Session::kept_second_image() const {
    const std::scoped_lock lock(state_.mutex);
    if (state_.project.further_images().empty()) return std::nullopt;
    return state_.project.further_images().front();
}

std::string Session::second_title() const {
    const auto second = state_.second.get();
    return second ? second->opened.title : "";
}

void Session::add_note(const std::string& sentence) {
    const std::scoped_lock lock(state_.mutex);
    state_.notes.push_back(sentence);
}

}  // namespace kontur::viewer
