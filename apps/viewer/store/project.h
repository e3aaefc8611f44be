// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/images/image_reference.h"
#include "viewer/model/model.h"
#include "viewer/store/database.h"

namespace kontur::viewer {

/// One row before and after an edit; `before` is empty for what the edit made, `after` for what it removed.
template <class Row>
struct Change {
    Id id = 0;
    std::optional<Row> before, after;
};

struct BordersChange {
    Borders before, after;
};

struct UseImageChange {
    bool before = false, after = false;
};

struct CycleChange {
    std::optional<double> before, after;  ///< as State has it
};

/// One step of the history.
struct Commit {
    std::string label;  ///< what the user did, as in "Undo: LABEL"
    std::vector<Change<Structure>> structures;
    std::vector<Change<DrawnContour>> contours;
    std::optional<BordersChange> borders{};
    std::optional<UseImageChange> use_image{};
    std::vector<std::shared_ptr<const StoredMask>> masks{};  ///< that its structures correct; they stay when it is undone
    std::optional<CycleChange> cycle{};

    bool is_empty() const { return structures.empty() && contours.empty() && !borders && !use_image && !cycle; }
};

/// A project file: the present state, every step that led there and every step that was undone, and the image's name. What
/// a call has stored when it returns survives the loss of the process. Only the present state is in memory, so a long
/// history costs nothing. Not safe for concurrent use.
class Project {
public:
    /// Opens the file, or creates it for `image`. Throws Error(io) when another process has it open or it cannot be
    /// written, Error(corrupt_file) when it is no project or damaged, Error(unsupported) for one of a newer kontur.
    Project(const std::filesystem::path& path, const ImageReference& image);

    const std::filesystem::path& path() const { return database_.path(); }
    const State& state() const { return state_; }
    const ImageReference& image() const { return image_; }
    /// Whether nothing had ever been in it when it was opened: made now, or at a start that failed before it was filled.
    bool is_new() const { return is_new_; }

    /// What the opened image says, not stored: which volume in time it is, to which contours without a time belong, and its
    /// cycle, which counts where nobody has said one.
    void set_times(int opened, std::optional<double> cycle_frames) {
        state_.opened_time = opened;
        if (!state_.cycle_frames) state_.cycle_frames = cycle_frames;
    }

    /// Whether nothing can be changed, because the file cannot be written.
    bool is_read_only() const { return is_read_only_; }

    /// An id for the next structure or contour.
    Id new_id() { return next_id_++; }
    /// Whether one has, or had, this id.
    bool has_given(Id id) const { return id >= 1 && id < next_id_; }

    /// What a new project begins with, before its first step: nobody can undo it. Throws as `commit`.
    void begin_with(const Commit& commit);
    /// Stores the step, drops what was undone before, and makes `after` present. Nothing changes when it throws:
    /// Error(invalid_input) for a contour that could not be read again, Error(io) when the file is not there any more.
    void commit(const Commit& commit);
    /// Goes back or forward one step and returns what that changed, `before` and `after` in the direction of the move;
    /// nothing at the end of the history.
    std::optional<Commit> undo();
    std::optional<Commit> redo();
    /// What undo and redo would do; empty at the end of the history.
    std::optional<std::string> undo_label();
    std::optional<std::string> redo_label();

    /// The page's own settings: a JSON text that nobody here looks into. Not part of the history.
    std::string page_state();
    void save_page_state(std::string_view json);
    void save_image(const ImageReference& image);

    /// Images that are shown beside the one it was drawn on, in the order of their numbers from 1. Not part of the history.
    const std::vector<ImageReference>& further_images() const { return further_images_; }
    void save_further_images(std::vector<ImageReference> images);

    /// The file itself, for checks of it.
    Database& database() { return database_; }

    /// A copy as a new file; the target must not exist.
    void copy_to(const std::filesystem::path& target) { database_.copy_to(target); }

private:
    void create(const ImageReference& image);
    void write_image(const ImageReference& image);
    void check_storable(const Commit& commit) const;
    void load();
    std::string setting(std::string_view key);
    void save_setting(std::string_view key, std::string_view value);
    std::optional<std::string> label(std::int64_t number);
    std::optional<Commit> step(std::int64_t number);
    void store(const Commit& commit, std::int64_t new_position);
    void store_masks(const Commit& commit);
    void store_version(const Commit& commit);
    void load_masks();
    void apply(const Commit& commit);

    Database database_;
    ImageReference image_;
    std::vector<ImageReference> further_images_;
    State state_;
    std::int64_t position_ = 0;  ///< number of the last step that counts
    Id next_id_ = 1;
    bool is_new_ = false, is_read_only_ = false;
};

/// Which image an existing project was drawn on. Throws as the constructor does.
ImageReference image_of_project(const std::filesystem::path& path);

}  // namespace kontur::viewer
