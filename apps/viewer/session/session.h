// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/stop.h"
#include "viewer/session/replies.h"
#include "viewer/session/session_state.h"

namespace kontur::viewer {

/// Everything behind the page: the image, the project, the surfaces. Speaks the messages of docs/viewer-protocol.md and
/// knows nothing of the network. Safe for concurrent use; edits are carried out one after the other.
class Session {
public:
    Session(OpenedImage image, const std::filesystem::path& project) : state_(std::move(image), project) {}

    /// Whom to tell events, from any thread. An empty function: nobody.
    void on_event(Pages::Listener listener) { state_.pages.on_event(std::move(listener)); }
    /// Something that the user should know.
    void notice(std::string_view level, const std::string& text) { state_.pages.notice(level, text); }

    /// Carries out one message of a page and returns the reply. Never throws.
    std::string call(std::string_view message, PageId page = 0);
    /// The page is closed: what it drafted is dropped. Never throws.
    void left(PageId page);

    // As session/replies.h has them.
    std::string greeting(const nlohmann::json& more = nlohmann::json::object()) { return viewer::greeting(state_, more); }
    std::string slice(std::string_view request) { return slice_reply(state_, request); }
    std::string mesh(Id structure, bool coded = false, const MeshExtras& extras = {.widths = true}) {
        return mesh_reply(state_, structure, coded, extras);
    }
    Download exported(const std::string& name, std::optional<Id> structure, const StopToken& stop = {},
                      std::optional<int> time = {}) {
        return viewer::exported(state_, {name, structure, time}, stop);
    }
    std::string statistics(const StopToken& stop = {}, std::optional<int> time = {}) {
        return statistics_reply(state_, time, stop);
    }
    std::string compare(Id first, Id second, const StopToken& stop = {}, std::optional<int> time = {}) {
        return comparison_reply(state_, {first, second, time}, stop);
    }
    ImportReply import(const std::string& bytes, const Upload& upload, const StopToken& stop = {}) {
        return viewer::import(state_, bytes, upload, stop);
    }
    std::string drawings(const StopToken& stop = {}) const { return drawings_reply(state_, stop); }
    ImportReply import_near(const std::filesystem::path& file, const Upload& upload, const StopToken& stop = {}) {
        return viewer::import_near(state_, file, upload, stop);
    }
    std::vector<Id> add_structures(const std::string& label, const std::vector<ContourSet>& sets,
                                   const ImportedMasks& masks = {}) {
        return viewer::add_structures(state_, label, sets, {}, masks);
    }
    void begin_with(const std::vector<ContourSet>& sets) { viewer::begin_with(state_, sets); }
    void put_second_image(OpenedImage opened) { viewer::put_second_image(state_, std::move(opened)); }

    /// Whether the project was empty when it was opened, its history too.
    bool is_new() const { return state_.project.is_new(); }
    const std::filesystem::path& project_path() const { return state_.project.path(); }
    const std::string& title() const { return state_.image.title; }
    /// Where the image was, or "phantom".
    std::string image_path() const;
    /// As DICOM has it; "CT" of other files whose values look like it; else "".
    std::string modality() const;
    /// The second image that is kept with the project, whether it could be read or not.
    std::optional<ImageReference> kept_second_image() const;
    /// Of the image that is shown beside the project's own; "" while there is none.
    std::string second_title() const;
    /// A further sentence of what had to be decided on reading.
    void add_note(const std::string& sentence);

    State state() const { return state_.state(); }
    /// Waits until all surfaces are finished; for tests.
    void wait_for_surfaces() { state_.surfaces.wait(); }

private:
    SessionState state_;
};

}  // namespace kontur::viewer
