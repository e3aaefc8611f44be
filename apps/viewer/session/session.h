// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "kontur/base/error.h"
#include "kontur/shape/volume.h"
#include "kontur/view/reslice.h"
#include "viewer/edits/sketch.h"
#include "viewer/edits/slice_edges.h"
#include "viewer/files/imports.h"
#include "viewer/files/kept_fits.h"
#include "viewer/images/further_image.h"
#include "viewer/images/opened_image.h"
#include "viewer/images/views.h"
#include "viewer/store/project.h"
#include "viewer/surfaces/surfaces.h"

namespace kontur::viewer {

class Members;

/// What an import came to: structures, or why the contours may not belong to the image, and then nothing has changed.
struct ImportReply {
    std::vector<Id> structures;
    std::vector<std::string> doubts;
    std::vector<std::string> notes;  ///< what was left out, or had to be decided
};

/// Of an open page; 0: of nobody.
using PageId = std::uint64_t;

/// What is told of a surface's points besides where they are.
struct MeshExtras {
    bool widths = false;           ///< of the 90 % band there, which take longer than all the rest
    std::optional<Id> far_from{};  ///< how far they are from the surface of this structure
};

/// There was a structure with this id.
class StructureRemoved : public Error {
public:
    using Error::Error;
};

/// A name and the bytes of a file to download.
struct Download {
    std::string file_name;
    std::string content_type;
    std::string bytes;
};

/// The event that tells pages something the user should know.
std::string notice_event(std::string_view level, const std::string& text);

/// Everything behind the page: the image, the project, the surfaces. Speaks the messages of docs/viewer-protocol.md and
/// knows nothing of the network. Safe for concurrent use; edits are carried out one after the other.
class Session {
public:
    Session(OpenedImage image, const std::filesystem::path& project);
    ~Session();

    /// Whom to tell events, from any thread. An empty function: nobody.
    void on_event(std::function<void(const std::string& message)> listener);

    /// The `session` event for a page that has just come.
    /// With further members of whoever serves it.
    std::string greeting(const nlohmann::json& more = nlohmann::json::object());
    /// Carries out one message of a page and returns the reply. Never throws.
    std::string call(std::string_view message, PageId page = 0);
    /// The page is closed: what it drafted is dropped. Never throws.
    void left(PageId page);

    // Replies to HTTP requests; errors are exceptions.
    std::string slice(std::string_view request);
    /// Without triangles, and at the stage "none", where there is no surface: it may go while it is asked for.
    /// `coded`: in few bytes, which are worth compressing.
    std::string mesh(Id structure, bool coded = false, const MeshExtras& extras = {.widths = true});
    /// These three throw StructureRemoved for a structure that another page has removed meanwhile.
    Download exported(const std::string& name, std::optional<Id> structure, const std::stop_token& stop = {});
    /// Of all structures with contours, as JSON.
    std::string statistics(const std::stop_token& stop = {});
    /// How two structures agree, voxel by voxel, as JSON.
    std::string compare(Id first, Id second, const std::stop_token& stop = {});
    ImportReply import(const std::string& bytes, const Upload& upload, const std::stop_token& stop = {});
    /// Structure sets and segmentations that lie near a DICOM image and were drawn on it, or in its frame of reference, as
    /// JSON.
    std::string drawings(const std::stop_token& stop = {}) const;
    /// Imports one of these. Throws Error(invalid_input) for another file, and as `import`.
    ImportReply import_near(const std::filesystem::path& file, const TraceRequest& trace, bool anyway,
                            const std::stop_token& stop = {});

    /// One structure for each set, as one step of the history.
    std::vector<Id> add_structures(const std::string& label, const std::vector<ContourSet>& sets);
    /// A new project's first structures, before its history.
    void begin_with(const std::vector<ContourSet>& sets);

    /// Whether the project was empty when it was opened, its history too.
    bool is_new() const { return project_.is_new(); }
    const std::filesystem::path& project_path() const { return project_.path(); }
    const std::string& title() const { return title_; }
    /// Where the image was, or "phantom".
    std::string image_path() const;
    /// As DICOM has it; "CT" of other files whose values look like it; else "".
    std::string modality() const;

    /// Shows it beside the project's own image, in place of the one that was; kept with the project. Throws as
    /// `assumptions_of_one_space`, and then nothing changes.
    void put_second_image(OpenedImage opened);
    /// The one that is kept with the project, whether it could be read or not.
    std::optional<ImageReference> kept_second_image() const;
    /// Of the image that is shown beside the project's own; "" while there is none.
    std::string second_title() const;
    /// A further sentence of what had to be decided on reading.
    void add_note(const std::string& sentence);

    /// Something that the user should know.
    void notice(std::string_view level, const std::string& text);
    State state() const;
    /// The structure; throws StructureRemoved, or as `structure_of` for an id that none can have had.
    const Structure& structure_asked_for(const State& now, Id id) const;
    /// Waits until all surfaces are finished; for tests.
    void wait_for_surfaces() { surfaces_.wait(); }

private:
    /// What a page sees in one of its views.
    struct WatchedPlane {
        std::string page, view;
        Reslice raster;
        nlohmann::json plane;  ///< as the page named it
    };
    struct Call {
        nlohmann::json (Session::*method)(const Members&);
        bool needs_project = true;  ///< false: it only looks at the image, and edits and slices need not wait for it
    };
    static const std::map<std::string, Call, std::less<>>& calls();

    nlohmann::json path(const Members& m);
    nlohmann::json outline_of(const Members& m);
    nlohmann::json suggest(const Members& m);
    nlohmann::json add_contour(const Members& m);
    nlohmann::json move_control_point(const Members& m);
    nlohmann::json insert_control_point(const Members& m);
    nlohmann::json delete_control_point(const Members& m);
    nlohmann::json pull_contour(const Members& m);
    nlohmann::json redraw_contour(const Members& m);
    nlohmann::json translate_contour(const Members& m);
    nlohmann::json copy_contour(const Members& m);
    nlohmann::json set_contour(const Members& m);
    nlohmann::json set_contours(const Members& m);
    nlohmann::json remove_contours(const Members& m);
    nlohmann::json add_structure(const Members& m);
    nlohmann::json set_structure(const Members& m);
    nlohmann::json remove_structure(const Members& m);
    nlohmann::json add_single_point(const Members& m);
    nlohmann::json move_single_point(const Members& m);
    nlohmann::json set_single_point(const Members& m);
    nlohmann::json remove_single_point(const Members& m);
    nlohmann::json drop_draft(const Members& m);
    nlohmann::json undo(const Members& m);
    nlohmann::json redo(const Members& m);
    nlohmann::json value(const Members& m);
    nlohmann::json save_page(const Members& m);
    nlohmann::json ping(const Members& m);

    nlohmann::json set_image(const Members& m);
    nlohmann::json remove_image(const Members& m);
    nlohmann::json set_borders(const Members& m);
    nlohmann::json set_border_rule(const Members& m);

    /// Stores a new or changed contour, or only shows it when the call is a draft.
    nlohmann::json put(const std::string& label, DrawnContour contour, const Members& m);
    nlohmann::json put_points(const std::string& label, const Structure& after);
    nlohmann::json moved(const std::optional<Commit>& step);
    Commit new_structures(const std::string& label, const std::vector<ContourSet>& sets);
    void commit(const Commit& commit);
    /// The same for a step that makes or changes one contour: its surface is computed while the disk is written.
    void commit_ahead(const Commit& step);
    void tell_changes(const Commit& commit);
    void announce(const Commit& commit);
    std::set<Id> touched_surfaces(const Commit& commit) const;
    /// Of a step that touches all, one after the other.
    void follow_touched(const Commit& step, const std::set<Id>& touched);
    SurfaceTask surface_task(Id structure) const;
    void follow(Id structure) { surfaces_.follow(surface_task(structure)); }
    void clear_draft();
    std::set<Id> drafted() const;
    /// Neighbours' contours in the plane of a changed contour, where their lines ran along its old one.
    std::vector<DrawnContour> carried_with(const DrawnContour& contour);
    /// Whether two structures have no voxel in common, by a rule, or as their surfaces lie.
    bool exclude(Id a, Id b) const;
    /// The image that surfaces are asked of; null where the project does not use it, or it cannot tell borders.
    std::shared_ptr<const Image> image_to_ask() const;
    /// For pages: null where the image cannot tell borders.
    nlohmann::json use_image() const;
    void commit_borders(const std::string& label, Borders after);
    void tell_borders(const std::vector<BorderPair>& pairs, const std::string& problem);
    nlohmann::json borders_found(const std::vector<BorderPair>& pairs) const;
    nlohmann::json history();
    std::string unit() const { return unit_of(identity_, *image_); }
    void show_second_image(std::shared_ptr<const FurtherImage> shown);
    /// Null while there is none.
    std::shared_ptr<const FurtherImage> second_image() const;
    nlohmann::json further_images() const;
    /// 0: the project's own. Null: it is not there. Throws Error(invalid_input) for a number that none can have.
    std::shared_ptr<const Image> image_numbered(int number, std::optional<int> time);
    /// The project's own image at another time; unset: at its own.
    std::shared_ptr<const Image> image_at(std::optional<int> time) { return times_.image(time.value_or(times_.own())); }
    nlohmann::json page_state();
    nlohmann::json surface_event(const Surface& surface) const;
    SurfaceEvidence evidence_of(const Surface& surface) const;
    void tell(const nlohmann::json& event);
    void watch(WatchedPlane plane);
    void tell_outlines(Id structure, std::int64_t revision, const PlaneCutters& cut);
    void tell_status(const std::string& text, std::optional<double> fraction);
    auto status_teller() {
        return [this](const std::string& text, std::optional<double> done) { tell_status(text, done); };
    }

    const std::shared_ptr<const Image> image_;
    TimeAxis times_;
    const std::string title_;
    const std::string frame_of_reference_uid_;
    const std::optional<DicomSeries> series_;
    const DicomIdentity identity_;
    const Affine3 mm_to_index_;
    const std::vector<WindowPreset> presets_;
    const Window window_;
    const std::pair<double, double> range_;
    const bool shows_borders_;  ///< no label map, nor the same value everywhere
    SliceEdges edges_;
    KeptFits fits_;
    mutable std::mutex listener_mutex_;
    std::function<void(const std::string&)> listener_;

    std::mutex watched_mutex_;
    std::vector<WatchedPlane> watched_;  ///< the latest of each page's views, the newest last

    mutable std::mutex second_mutex_;
    std::shared_ptr<const FurtherImage> second_;

    mutable std::mutex mutex_;  ///< of what follows
    std::vector<std::string> notes_;
    Project project_;
    std::optional<DrawnContour> draft_;  ///< stands for the contour with its id, or is a new one (id 0)
    std::vector<DrawnContour> carried_;  ///< neighbours' contours that go with it, in place of those with their ids
    PageId caller_ = 0;                  ///< whose call is carried out
    PageId draft_owner_ = 0;

    Surfaces surfaces_;  ///< last: its thread tells events
};

}  // namespace kontur::viewer
