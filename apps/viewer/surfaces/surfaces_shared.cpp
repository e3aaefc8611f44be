// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <system_error>

#include "kontur/base/error.h"
#include "viewer/surfaces/surfaces.h"

// The borders that structures share, found when their surfaces are finished.

namespace kontur::viewer {
namespace {

bool is_same(const TriangleMesh& a, const TriangleMesh& b) { return a.points == b.points && a.triangles == b.triangles; }

/// As it was fitted, but for the surface itself.
Surface with_mesh(const Surface& alone, std::shared_ptr<const TriangleMesh> mesh) {
    Surface surface = alone;
    surface.revision = 0;
    if (mesh == alone.mesh) return surface;
    surface.mesh = std::move(mesh);
    surface.function.reset();
    surface.volume_ml = signed_volume_mm3(*surface.mesh) / 1000;
    SurfaceEvidence evidence = *surface.evidence;
    evidence.volume_mm3 = 1000 * surface.volume_ml;
    surface.evidence = std::make_shared<const SurfaceEvidence>(std::move(evidence));
    return surface;
}

/// As `segment` would fit it.
LoneSurface refitted(const LoneSurface& alone, const ContourSet& contours, std::optional<double> smoothing,
                     const Image* image, const Work& work) {
    EditorOptions options;
    options.segment.smoothing = smoothing;
    EditedSurface finished = Editor(options).finish(contours, image, work);
    return {alone.structure, alone.drawn, finished.function, std::make_shared<const TriangleMesh>(std::move(finished.mesh))};
}

}  // namespace

void Surfaces::share_borders(const Borders& borders) {
    const std::scoped_lock lock(mutex_);
    if (borders == borders_) return;
    borders_ = borders;
    let_masks_follow_locked();
    sharing_stop_.request_stop();
    if (!alone_.empty() && !is_busy_locked()) ask_to_share_locked();
}

std::vector<BorderPair> Surfaces::border_pairs() const {
    const std::scoped_lock lock(mutex_);
    return pairs_;
}

/// Whether the finished surface is told by the other thread, with its borders. Where more structures are on their way it is
/// told as it is, so that they come to be seen one by one.
bool Surfaces::hand_over(const SurfaceTask& task, const Alone& alone) {
    const std::scoped_lock lock(mutex_);
    Follower& follower = followers_[task.structure];
    if (follower.tasks.size() != 1 || follower.is_outdated) return false;
    if (alone.surface.stage != SurfaceStage::finished || task.motion) return alone_.erase(task.structure), false;
    alone_[task.structure] = {alone.surface, alone.function, task.smoothing, image_of(task)};
    const bool is_last = later_.empty() && std::all_of(followers_.begin(), followers_.end(), [&](const auto& other) {
                             return other.first == task.structure || !other.second.is_working;
                         });
    if (!borders_.shared || alone_.size() < 2 || !is_last || !ask_to_share_locked()) return false;
    finish_locked(follower, task);
    return true;
}

/// False where no thread could be started: borders are then not shared.
bool Surfaces::ask_to_share_locked() {
    try {
        if (!sharing_thread_.joinable()) sharing_thread_ = std::thread([this] { keep_sharing(); });
    } catch (const std::system_error&) {
        return false;
    }
    is_sharing_wanted_ = true;
    sharing_changed_.notify_all();
    return true;
}

void Surfaces::keep_sharing() {
    while (true) {
        std::map<Id, Alone> alone;
        Borders borders;
        StopSource stop;
        {
            std::unique_lock lock(mutex_);
            is_sharing_ = false;
            sharing_changed_.notify_all();
            sharing_changed_.wait(lock, [&] { return is_sharing_wanted_ || is_ending_; });
            if (is_ending_) return;
            is_sharing_wanted_ = false;
            is_sharing_ = true;
            sharing_stop_ = stop;
            alone = alone_;
            borders = borders_;
        }
        share(alone, borders, stop.token());
    }
}

void Surfaces::share(const std::map<Id, Alone>& alone, const Borders& borders, const StopToken& stop) {
    SharedBorders found;
    std::string problem;
    try {
        std::vector<LoneSurface> surfaces;
        for (const auto& [id, one] : alone) surfaces.push_back({id, one.surface.drawn, one.function, one.surface.mesh});
        const Refit refit = [&](const LoneSurface& lone, const ContourSet& contours, const Work& work) {
            const Alone& known = alone.at(lone.structure);
            return refitted(lone, contours, known.smoothing, known.image.get(), work);
        };
        if (borders.shared) found = sharing_.share(surfaces, borders, {.stop = stop}, refit);
        if (stop.stop_requested()) return;
    } catch (const std::exception& error) {
        const auto* known = dynamic_cast<const Error*>(&error);
        if (known && known->kind() == ErrorKind::cancelled) return;
        problem = error.what();
    }
    for (const auto& [id, one] : alone) {
        const auto shared = found.meshes.find(id);
        publish_shared(one, shared == found.meshes.end() ? one.surface.mesh : shared->second);
    }
    {
        const std::scoped_lock lock(mutex_);
        if (pairs_ == found.pairs && problem.empty()) return;
        pairs_ = found.pairs;
    }
    if (listener_.borders) listener_.borders(found.pairs, problem);
}

/// Unless it is shown already, or another one is on its way.
void Surfaces::publish_shared(const Alone& alone, std::shared_ptr<const TriangleMesh> mesh) {
    const Id id = alone.surface.structure;
    const auto is_wanted = [&] {
        const auto now = alone_.find(id);
        const Follower& follower = followers_[id];
        return now != alone_.end() && now->second.surface.mesh == alone.surface.mesh && !follower.is_working &&
               !follower.is_outdated;
    };
    {
        const std::scoped_lock lock(mutex_);
        if (!is_wanted()) return;
        const Surface& latest = *latest_.at(id);
        if (latest.stage == SurfaceStage::finished && latest.drawn == alone.surface.drawn && is_same(*latest.mesh, *mesh))
            return;
    }
    Surface surface = with_mesh(alone.surface, std::move(mesh));
    surface.revision = next_revision();
    listener_.outlines(id, surface.revision, cutters(surface));
    const std::scoped_lock lock(mutex_);
    if (!is_wanted()) surface.stage = SurfaceStage::preview;  // only on the way to another one
    publish_locked(std::move(surface));
}

}  // namespace kontur::viewer
