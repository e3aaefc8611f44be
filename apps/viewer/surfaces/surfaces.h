// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "kontur/base/stop.h"
#include "kontur/live_editor.h"
#include "kontur/sureness/surface_evidence.h"
#include "viewer/model/model.h"
#include "viewer/surfaces/border_sharing.h"
#include "viewer/surfaces/derivations.h"
#include "viewer/surfaces/edges_beside.h"
#include "viewer/surfaces/mask_editor.h"
#include "viewer/surfaces/motions.h"
#include "viewer/surfaces/section_faults.h"

namespace kontur::viewer {

enum class SurfaceStage {
    none,
    outdated,  ///< the contours have changed since; the next one is on its way
    preview,
    asking,  ///< what the contours make of themselves; the image is asked now whether it knows better
    finished,
};
std::string_view name(SurfaceStage stage) noexcept;
/// Whether all is known of the surface that there is to know.
constexpr bool has_full_resolution(SurfaceStage stage) {
    return stage == SurfaceStage::asking || stage == SurfaceStage::finished;
}

/// Two contours that contradict each other at a place.
struct Conflict {
    Id contour = 0, other = 0;
    Vec3 at;
    double disagreement_mm = 0;
};

/// On which hand of an open line that does not tell the structure was taken to lie.
struct LineSide {
    Id contour = 0;
    Hand inside = Hand::left;
    bool is_sure = true;
};

/// Two lines of one plane that were taken for one, or leave a thin wall, the first of them a hole in the other.
struct LinePair {
    Id contour = 0, other = 0;
    double apart_mm = 0;
    bool is_one = false;
};

/// What is shown of a structure's surface.
struct Surface {
    Id structure = 0;
    std::int64_t revision = 0;
    SurfaceStage stage = SurfaceStage::none;
    std::shared_ptr<const TriangleMesh> mesh;  ///< null for `none`
    std::vector<std::string> warnings;
    std::vector<LineSide> sides;
    std::vector<LinePair> near_lines;
    std::vector<Conflict> conflicts;  ///< the largest first; known when finished, and when there is no surface
    // Known when finished:
    std::vector<SurfaceFault> faults;
    std::vector<EdgeBeside> edges_beside;  ///< none where no image is asked
    double volume_ml = 0;
    Residual residual;
    Id worst_contour = 0;  ///< where the residual is largest
    Vec3 worst_at;
    std::shared_ptr<const SurfaceEvidence> evidence;    ///< how sure it is
    std::shared_ptr<const ContourSet> drawn;            ///< what it was made from
    ImageReport image;                                  ///< what became of the image, when finished
    std::shared_ptr<const TriangleMesh> without_image;  ///< what the contours alone make; null where no image was used
    std::shared_ptr<const MaskEdit> corrected;          ///< of a mask to be corrected; null else
    std::optional<int> time;                            ///< of a structure that moves: it is its surface at this time alone
    std::optional<ImplicitFunction> function;  ///< that the mesh is the surface of; none of masks and shared borders
    bool is_derived = false;                   ///< a rule made it
};

/// The contours a surface is made of; `ids[i]` names `set.contours[i]`.
struct SurfaceTask {
    Id structure = 0;
    ContourSet set;
    std::vector<Id> ids;
    std::optional<double> smoothing{};         ///< of the fit; unset: the usual one
    std::shared_ptr<const StoredMask> mask{};  ///< that the contours correct; null: they are all there is
    StructureMask how{};                       ///< it is corrected
    std::shared_ptr<const StoredMask> kept{};  ///< what it stays, if it is locked
    std::uint64_t step = 0;                    ///< of the session that it comes with; a draft comes with the next one
    /// Of contours of another time than the opened one the image to be asked; null: none is.
    std::optional<std::shared_ptr<const Image>> image{};
    /// Of a structure that moves: all of it. `set` then holds the contours of one time, and sections that stand for others.
    std::optional<MotionTask> motion{};
    int time = 0;                    ///< of the contours of a structure that moves
    std::optional<RuleTask> rule{};  ///< that makes it; there are no contours then
};

/// A surface as it is seen at one time.
struct ShownSurface {
    std::int64_t revision = 0;
    SurfaceStage stage = SurfaceStage::none;
    std::shared_ptr<const TriangleMesh> mesh, without_image;
};

/// The closed lines, in mm, where a surface meets a plane.
using PlaneCutter = std::function<std::vector<std::vector<Vec3>>(const Plane& plane)>;

struct PlaneCutters {
    PlaneCutter surface;
    PlaneCutter without_image{};  ///< what the contours alone make; none where no image was used
    std::optional<int> time{};    ///< of a structure that moves: these are its lines at this time alone
};
PlaneCutters cutters(const Surface& surface);

/// Called from the threads that compute, and from those that change contours. Must not call Surfaces.
struct SurfaceListener {
    /// Told before the surface with this revision, which of previews takes as long again.
    std::function<void(Id structure, std::int64_t revision, const PlaneCutters& cut)> outlines;
    std::function<void(std::shared_ptr<const Surface>)> surface;
    /// What is being computed, and how much of it is done; an empty text when nothing is.
    std::function<void(const std::string& text, std::optional<double> fraction)> status;
    /// How structures that touch lie to each other, as soon as that is found, or why it could not be.
    std::function<void(const std::vector<BorderPair>& pairs, const std::string& problem)> borders{};
    /// A structure that moves, whenever there is more of it.
    std::function<void(const std::shared_ptr<const Motion>&)> motion{};
};

/// A LiveEditor for each structure that has contours: surfaces follow the contours, previews at once, the finished ones when
/// the hand rests, and then those that the image helps to make. Where structures share borders a finished surface waits
/// until these are found, and then the surfaces of its neighbours change, too: on a thread of its own, from the functions
/// that there are.
class Surfaces {
public:
    explicit Surfaces(SurfaceListener listener, std::shared_ptr<BodyOutlines> bodies = std::make_shared<BodyOutlines>())
        : listener_(std::move(listener)),
          motions_([this] { return next_revision(); },
                   [this](const std::shared_ptr<const Motion>& motion) {
                       if (listener_.motion) listener_.motion(motion);
                   }),
          derivations_([this] { return all(); }, [this](Surface surface) { publish_derived(std::move(surface)); },
                       [this](std::optional<double> done) { show_derivation(done); }, std::move(bodies)) {}
    ~Surfaces();
    Surfaces(const Surfaces&) = delete;
    Surfaces& operator=(const Surfaces&) = delete;

    /// The structures' contours change, and `follow` will say how: whoever is told of the change after this knows already
    /// that the surfaces are those of before.
    void outdate(const std::set<Id>& structures);
    /// The structure's contours are now these. Does not wait.
    void follow(SurfaceTask task);
    /// The same for a structure that nobody waits for: such ones come one after the other, when nothing else is computed,
    /// or in place of what is computed for them already.
    void follow_later(SurfaceTask task);
    /// Throws Error(invalid_input) for a line that can be no correction of the structure's mask, beside the others of its
    /// plane; they are the last of `plane` and those before it.
    void check_correction(Id structure, const std::shared_ptr<const StoredMask>& mask, ContourSet plane);
    /// Contours that are followed from now on were drawn on this image, and it is asked; null: none is.
    void use_image(std::shared_ptr<const Image> image);
    /// From now on these hold. Does not wait.
    void share_borders(const Borders& borders);
    /// How structures lie to each other as far as it has been found.
    std::vector<BorderPair> border_pairs() const;
    /// Waits until every surface is finished, with its borders.
    void wait();

    /// The last surface of every structure that has had one.
    std::map<Id, std::shared_ptr<const Surface>> all() const;
    /// What is seen of each structure at a time: of one that moves its surface there, as far as it has been made.
    std::map<Id, ShownSurface> at(int time) const;
    /// What the rule would make of what is seen just now. Throws Error(invalid_input) where something is not there yet, and
    /// as derived_surfaces does.
    TriangleMesh preview_of(const RuleTask& task) { return derivations_.preview(task); }
    /// Structures that move, at all times.
    Motions& motions() { return motions_; }
    const Motions& motions() const { return motions_; }

private:
    /// A finished surface as it was fitted, before borders are shared.
    struct Alone {
        Surface surface;
        ImplicitFunction function;
        std::optional<double> smoothing{};     ///< of its fit
        std::shared_ptr<const Image> image{};  ///< that was asked, if any was
    };
    struct Follower {
        std::map<std::uint64_t, SurfaceTask> tasks;  ///< by number of the edit, counted through all editors
        std::uint64_t last_edit = 0;                 ///< its number
        std::uint64_t edits_before = 0;              ///< of editors that there were before this one
        bool is_working = false;
        bool is_outdated = false;            ///< there will be another task
        Alone without_image;                 ///< of the task for which the image is asked
        bool shows_image = false;            ///< the preview follows what the image said before: until it has been asked
                                             ///< again nothing else is shown, which would jump there and back
        std::int64_t ahead = 0;              ///< revision of the preview whose outlines have been told
        std::string_view stage;              ///< what the status line was told last ...
        int tenths = 0;                      ///< ... and how far it was
        std::shared_ptr<LiveEditor> editor;  ///< null without contours: each one is a thread
        std::optional<double> smoothing{};   ///< with which the editor was made
        std::shared_ptr<MaskEditor> mask_editor;         ///< in place of the editor, of a mask with corrections
        std::shared_ptr<const MaskExchange> exchange{};  ///< of a mask: by its corrections
        std::optional<MaskExchanges> others{};           ///< of a mask: that it follows; unset: borders are not shared
    };
    using Editors = std::vector<std::shared_ptr<LiveEditor>>;
    using Retired = std::vector<std::shared_ptr<void>>;

    void start(SurfaceTask task);
    void begin_editor(Follower& follower, const SurfaceTask& task);
    void start_next();
    void hear(Id structure, std::uint64_t edit, const EditorUpdate& update);
    void hear_ahead(Id structure, std::uint64_t edit, const SurfaceBand& band);
    std::int64_t next_revision();
    std::shared_ptr<const Image> image_of(const SurfaceTask& task) const;
    void show_progress(Id structure, std::uint64_t edit, const EditorUpdate& update);
    void outdate_locked(Id structure);
    void publish_locked(Surface surface);
    Alone heard(const SurfaceTask& task, const EditorUpdate& update, Alone known);
    void finish_locked(Follower& follower, const SurfaceTask& task);

    // Sharing borders (surfaces_shared.cpp).
    // Masks to be corrected (surfaces_masks.cpp).
    void start_mask(Follower& follower, SurfaceTask task);
    void begin_mask_editor(Follower& follower, Id structure, const std::shared_ptr<const StoredMask>& mask);
    void hear_mask(Id structure, std::uint64_t edit, const MaskUpdate& update);
    void pass_on_locked(Follower& follower, const MaskUpdate& update);
    const StoredMask* mask_of_locked(Id structure) const;
    bool may_share_locked(Id a, Id b);
    MaskExchanges others_of_locked(Id structure);
    void let_masks_follow_locked();
    void forget_mask_locked(Follower& follower);

    // Structures that rules make (surfaces_derived.cpp).
    void start_rule(Follower& follower, RuleTask task);
    void publish_derived(Surface surface);
    void show_derivation(std::optional<double> done);

    bool is_busy_locked() const;
    bool hand_over(const SurfaceTask& task, const Alone& alone);
    bool ask_to_share_locked();
    void end_editors();
    void keep_sharing();
    void share(const std::map<Id, Alone>& alone, const Borders& borders, const StopToken& stop);
    void publish_shared(const Alone& alone, std::shared_ptr<const TriangleMesh> mesh);

    const SurfaceListener listener_;
    mutable std::mutex mutex_;
    std::map<Id, std::shared_ptr<const Surface>> latest_;
    std::int64_t revision_ = 0;
    std::shared_ptr<const Image> image_;
    std::map<Id, Alone> alone_;
    Borders borders_;
    std::map<std::pair<std::string, std::string>, bool> masks_that_may_share_;  ///< by their hashes
    std::vector<BorderPair> pairs_;
    bool is_sharing_wanted_ = false, is_sharing_ = false, is_ending_ = false;
    StopSource sharing_stop_;
    std::condition_variable sharing_changed_;
    BorderSharing sharing_;  ///< of the thread
    std::deque<SurfaceTask> later_;
    Retired retired_;                   ///< not needed any more; an editor's own thread cannot end it
    std::map<Id, Follower> followers_;  ///< their threads use all above
    std::thread sharing_thread_;        ///< it does, too
    Motions motions_;                   ///< its thread does
    Derivations derivations_;           ///< last: its thread uses all above
};

}  // namespace kontur::viewer
