// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "kontur/extract/surface_band.h"
#include "kontur/sampling/sample_surface.h"
#include "kontur/shape/crossings.h"
#include "viewer/model/stage_words.h"

namespace kontur::viewer {
namespace {

constexpr std::size_t kMostConflicts = 20;
// A page fetches a preview's mesh and draws it, without a graphics processor, before the processors are taken to finish it.
constexpr std::chrono::milliseconds kRest{80};

/// The contour's point where the surface passes farthest.
Vec3 worst_point(const Contour& contour, const ImplicitFunction& function) {
    std::vector<double> values(contour.points.size());
    function.values(contour.points, values);
    const auto worst =
        std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    return contour.points[static_cast<std::size_t>(worst - values.begin())];
}

/// Whether all of these are contours of the structure: sections stand for contours where it moves.
bool are_drawn(std::initializer_list<Id> ids) { return std::ranges::find(ids, Id{0}) == ids.end(); }

/// Places where contours disagree by more than careful hands do, in large organs more than in small ones.
std::vector<Conflict> conflicts(const SurfaceTask& task, const std::vector<Crossing>& crossings) {
    const double least_mm = std::max(1.0, 0.015 * diameter_mm(task.set));
    std::vector<Conflict> found;
    for (const Crossing& crossing : crossings)
        if (crossing.disagreement_mm >= least_mm && are_drawn({task.ids[crossing.contour], task.ids[crossing.other]}))
            found.push_back({task.ids[crossing.contour], task.ids[crossing.other],
                             0.5 * (crossing.position + crossing.other_position), crossing.disagreement_mm});
    std::stable_sort(found.begin(), found.end(),
                     [](const Conflict& a, const Conflict& b) { return a.disagreement_mm > b.disagreement_mm; });
    if (found.size() > kMostConflicts) found.resize(kMostConflicts);
    return found;
}

/// Whether it is what the contours make without anything that an image said.
bool is_alone(const EditorUpdate& update) { return update.asks_image && update.surface.earlier_places == 0; }

Surface no_surface(Id structure, std::vector<std::string> warnings = {}) {
    Surface surface;
    surface.structure = structure;
    surface.warnings = std::move(warnings);
    return surface;
}

Surface surface_of(const SurfaceTask& task, const EditorUpdate& update) {
    Surface surface = no_surface(task.structure);
    if (task.motion) surface.time = task.time;
    if (update.kind == EditorUpdate::Kind::problem && !task.set.contours.empty()) surface.warnings.push_back(update.problem);
    if (update.surface.mesh.triangles.empty()) {
        if (!update.surface.finished || task.set.contours.empty()) return surface;
        surface.warnings.push_back("These contours give no surface: where they contradict each other, none is followed.");
        surface.conflicts = conflicts(task, find_crossings(task.set));
        return surface;
    }
    surface.stage = !update.surface.finished ? SurfaceStage::preview
                    : update.asks_image      ? SurfaceStage::asking
                                             : SurfaceStage::finished;
    surface.mesh = std::make_shared<const TriangleMesh>(update.surface.mesh);
    surface.function = update.surface.function;
    for (const FoundSide& found : update.surface.sides)
        if (are_drawn({task.ids[found.contour]}))
            surface.sides.push_back({task.ids[found.contour], found.inside, found.is_sure});
    for (const NearLines& pair : update.surface.near_lines)
        if (are_drawn({task.ids[pair.contour], task.ids[pair.other]}))
            surface.near_lines.push_back({task.ids[pair.contour], task.ids[pair.other], pair.apart_mm, pair.is_one});
    if (!update.surface.finished) return surface;
    surface.volume_ml = signed_volume_mm3(*surface.mesh) / 1000;
    surface.residual = update.surface.residual;
    surface.worst_contour = task.ids[surface.residual.worst_contour];
    surface.worst_at = worst_point(task.set.contours[surface.residual.worst_contour], update.surface.function);
    const std::vector<Crossing> crossings = find_crossings(task.set);
    surface.conflicts = conflicts(task, crossings);
    surface.faults = surface_faults(update.surface.section_check, task.ids);
    if (!task.motion)
        surface.evidence = std::make_shared<const SurfaceEvidence>(
            gather_evidence(sample_surface(*surface.mesh, update.surface.function), task.set,
                            {.volume_mm3 = 1000 * surface.volume_ml,
                             .residual_mm = surface.residual.rms_mm,
                             .disagreement_mm = trusted_disagreement_mm(disagreement(crossings)),
                             .shares = update.surface.image.shares}));
    surface.image = update.surface.image;
    surface.drawn = std::make_shared<const ContourSet>(task.set);
    return surface;
}

}  // namespace

Surfaces::~Surfaces() {
    end_editors();
    {
        const std::scoped_lock lock(mutex_);
        is_ending_ = true;
        sharing_stop_.request_stop();
        sharing_changed_.notify_all();
    }
    if (sharing_thread_.joinable()) sharing_thread_.join();
}

void Surfaces::end_editors() {
    Retired editors;  // ended without the lock, and before the map that their threads look through
    const std::scoped_lock lock(mutex_);
    later_.clear();
    sharing_stop_.request_stop();
    editors.swap(retired_);
    for (auto& [structure, follower] : followers_) {
        editors.push_back(std::move(follower.editor));
        editors.push_back(std::move(follower.mask_editor));
    }
}

void Surfaces::outdate(const std::set<Id>& structures) {
    const std::scoped_lock lock(mutex_);
    for (const Id structure : structures) {
        outdate_locked(structure);
        motions_.outdate(structure);
    }
    for (const Id user : derivations_.made_of(structures)) outdate_locked(user);  // they follow by themselves
}

void Surfaces::outdate_locked(Id structure) {
    if (const auto follower = followers_.find(structure); follower != followers_.end()) follower->second.is_outdated = true;
    const auto latest = latest_.find(structure);
    if (latest == latest_.end() || !has_full_resolution(latest->second->stage)) return;
    Surface outdated = *latest->second;
    outdated.stage = SurfaceStage::outdated;
    latest->second = std::make_shared<const Surface>(std::move(outdated));
    listener_.surface(latest->second);
}

void Surfaces::use_image(std::shared_ptr<const Image> image) {
    const std::scoped_lock lock(mutex_);
    image_ = std::move(image);
}

void Surfaces::follow(SurfaceTask task) {
    Retired retired;  // ended when the lock is free again, for which their threads may wait
    const std::scoped_lock lock(mutex_);
    retired.swap(retired_);
    std::erase_if(later_, [&](const SurfaceTask& waiting) { return waiting.structure == task.structure; });
    start(std::move(task));
    for (auto& editor : retired_) retired.push_back(std::move(editor));
    retired_.clear();
}

void Surfaces::follow_later(SurfaceTask task) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(later_, [&](const SurfaceTask& waiting) { return waiting.structure == task.structure; });
    const auto follower = followers_.find(task.structure);
    if (task.rule || (follower != followers_.end() && follower->second.is_working)) return start(std::move(task));
    later_.push_back(std::move(task));
    start_next();
}

bool Surfaces::is_busy_locked() const {
    return std::any_of(followers_.begin(), followers_.end(), [](const auto& f) { return f.second.is_working; });
}

void Surfaces::start_next() {
    while (!later_.empty() && !is_busy_locked()) {
        SurfaceTask task = std::move(later_.front());
        later_.pop_front();
        start(std::move(task));
    }
}

void Surfaces::start(SurfaceTask task) {
    const Id structure = task.structure;
    outdate_locked(structure);
    sharing_stop_.request_stop();
    if (task.motion) motions_.outdate(structure);
    else motions_.forget(structure);
    Follower& follower = followers_[structure];
    follower.is_outdated = false;
    if (!task.mask) forget_mask_locked(follower);
    if (task.rule) return start_rule(follower, std::move(*task.rule));
    derivations_.forget(structure);
    if (task.mask) return start_mask(follower, std::move(task));
    if (follower.mask_editor) {
        retired_.push_back(std::move(follower.mask_editor));
        follower.edits_before = follower.last_edit;
        follower.tasks.clear();
        follower.is_working = false;
    }
    if (follower.editor && follower.smoothing != task.smoothing) retired_.push_back(std::move(follower.editor));
    if (!follower.editor) {
        if (task.set.contours.empty()) return publish_locked(no_surface(structure));
        try {
            begin_editor(follower, task);
        } catch (const std::exception& error) {
            return publish_locked(no_surface(
                structure,
                {fmt::format("There is no surface until the next edit: no thread to compute it could be started ({}).",
                             error.what())}));
        }
    }
    // The lock makes the editor's answer wait until its task is known.
    follower.last_edit = follower.edits_before + follower.editor->edit(task.set, image_of(task));
    follower.is_working = true;
    follower.tasks[follower.last_edit] = std::move(task);
}

/// An editor has one smoothing for all of its life. What the one before still tells is older than every edit of this one.
void Surfaces::begin_editor(Follower& follower, const SurfaceTask& task) {
    const Id structure = task.structure;
    const std::uint64_t before = follower.last_edit;
    EditorOptions options;
    options.segment.smoothing = task.smoothing;
    follower.editor = std::make_shared<LiveEditor>(
        options, [this, structure, before](const EditorUpdate& update) { hear(structure, before + update.edit, update); },
        [this, structure, before](std::uint64_t edit, const SurfaceBand& band) {
            hear_ahead(structure, before + edit, band);
        },
        0, kRest);
    follower.edits_before = before;
    follower.smoothing = task.smoothing;
}

void Surfaces::wait() {
    for (bool is_done = false; !is_done;) {
        Editors editors;
        std::vector<std::shared_ptr<MaskEditor>> mask_editors;
        const auto edits = [this] {
            return std::accumulate(followers_.begin(), followers_.end(), std::uint64_t{0},
                                   [](std::uint64_t sum, const auto& one) { return sum + one.second.last_edit; });
        };
        std::uint64_t edits_before = 0;
        {
            const std::scoped_lock lock(mutex_);
            is_done = later_.empty();
            edits_before = edits();
            for (const auto& [structure, follower] : followers_)
                if (follower.editor) editors.push_back(follower.editor);
            for (const auto& [structure, follower] : followers_)
                if (follower.mask_editor) mask_editors.push_back(follower.mask_editor);
        }
        for (const auto& editor : mask_editors) editor->wait();
        for (const auto& editor : editors) editor->wait();
        std::unique_lock lock(mutex_);
        sharing_changed_.wait(lock, [&] { return !is_sharing_wanted_ && !is_sharing_; });
        is_done = is_done && later_.empty() && edits() == edits_before;  // masks follow others when these are there
    }
    motions_.wait();
    derivations_.wait();
}

std::map<Id, std::shared_ptr<const Surface>> Surfaces::all() const {
    const std::scoped_lock lock(mutex_);
    return latest_;
}

void Surfaces::hear(Id structure, std::uint64_t edit, const EditorUpdate& update) {
    if (update.kind == EditorUpdate::Kind::progress) return show_progress(structure, edit, update);
    SurfaceTask task;
    Alone known;
    bool is_held_back = false;
    std::shared_ptr<const Image> image;
    {
        const std::scoped_lock lock(mutex_);
        Follower& follower = followers_[structure];
        if (edit <= follower.edits_before) return;
        auto& tasks = follower.tasks;
        tasks.erase(tasks.begin(), tasks.lower_bound(edit));
        task = tasks.at(edit);
        image = image_of(task);
        known = std::exchange(follower.without_image, {});
        is_held_back = is_alone(update) && follower.shows_image;
    }
    Alone alone = heard(task, update, std::move(known));
    Surface& surface = alone.surface;
    if (image && surface.stage == SurfaceStage::finished) surface.edges_beside = edges_beside(task.set, task.ids, *image);
    const bool is_final = update.kind != EditorUpdate::Kind::preview && !update.asks_image;
    if (is_final && hand_over(task, alone)) return;
    if (has_full_resolution(surface.stage) && surface.revision == 0 && !is_held_back) {
        surface.revision = next_revision();
        listener_.outlines(structure, surface.revision, cutters(surface));
    }
    const std::scoped_lock lock(mutex_);
    Follower& follower = followers_[structure];
    if (is_alone(update)) follower.without_image = alone;
    if (is_held_back) return;
    if (update.kind == EditorUpdate::Kind::preview) {
        surface.revision = std::exchange(follower.ahead, 0);
        follower.shows_image = update.surface.earlier_places > 0;
    }
    const bool is_newest = follower.tasks.size() == 1 && !follower.is_outdated;
    // Of contours that have changed meanwhile it is only on the way to their surface.
    if (!is_newest && has_full_resolution(surface.stage)) surface.stage = SurfaceStage::preview;
    publish_locked(std::move(surface));
    if (!is_newest || !is_final) return;
    finish_locked(follower, task);
    // Of borders that are not shared any more, too: surfaces are those of before until then.
    if ((borders_.shared || sharing_thread_.joinable()) && !is_busy_locked()) ask_to_share_locked();
}

/// Where the image was not used, or could not be asked, it is the surface that is shown already, and keeps its revision.
Surfaces::Alone Surfaces::heard(const SurfaceTask& task, const EditorUpdate& update, Alone known) {
    const bool is_of_image = update.kind == EditorUpdate::Kind::with_image ||
                             (update.kind == EditorUpdate::Kind::problem && known.surface.stage == SurfaceStage::asking);
    const bool is_used = update.surface.image.verdict == ImageVerdict::used;
    if (!is_of_image || is_used) {
        Alone alone{surface_of(task, update), update.surface.function};
        if (is_used) alone.surface.without_image = known.surface.mesh;
        return alone;
    }
    if (known.surface.stage == SurfaceStage::asking) known.surface.stage = SurfaceStage::finished;
    if (update.kind == EditorUpdate::Kind::problem)
        known.surface.warnings.push_back(fmt::format("The image could not be asked: {}.", update.problem));
    known.surface.image = update.surface.image;
    return known;
}

void Surfaces::finish_locked(Follower& follower, const SurfaceTask& task) {
    follower.stage = {};
    follower.is_working = false;
    if (task.set.contours.empty() && follower.editor) {
        retired_.push_back(std::move(follower.editor));
        follower.tasks.clear();
    }
    if (task.motion) motions_.follow(*task.motion);
    listener_.status("", std::nullopt);
    start_next();
}

void Surfaces::hear_ahead(Id structure, std::uint64_t edit, const SurfaceBand& band) {
    const std::int64_t revision = next_revision();
    PlaneCutters cut{[&](const Plane& plane) { return band.cut(plane); }};
    {
        const std::scoped_lock lock(mutex_);
        Follower& follower = followers_[structure];
        if (edit <= follower.edits_before) return;
        follower.ahead = revision;
        const auto task = follower.tasks.find(edit);
        if (task != follower.tasks.end() && task->second.motion) cut.time = task->second.time;
    }
    listener_.outlines(structure, revision, cut);
}

std::int64_t Surfaces::next_revision() {
    const std::scoped_lock lock(mutex_);
    return ++revision_;
}

/// News by the tenth: more would only cost the page time.
void Surfaces::show_progress(Id structure, std::uint64_t edit, const EditorUpdate& update) {
    const int tenths = static_cast<int>(10 * update.done);
    std::string text;
    {
        const std::scoped_lock lock(mutex_);
        Follower& follower = followers_[structure];
        if (edit <= follower.edits_before || (follower.stage == update.stage && follower.tenths == tenths)) return;
        follower.stage = update.stage;
        follower.tenths = tenths;
        text = fmt::format("{}: {}", follower.tasks.at(edit).set.name, words_of_stage(update.stage));
    }
    listener_.status(text, tenths / 10.0);
}

/// Under the lock, so that no change of contours comes between what is told of a surface and what it is.
void Surfaces::publish_locked(Surface surface) {
    if (surface.revision == 0) surface.revision = ++revision_;
    auto& latest = latest_[surface.structure];
    latest = std::make_shared<const Surface>(std::move(surface));
    listener_.surface(latest);
    derivations_.heard(latest->structure);
}

}  // namespace kontur::viewer
