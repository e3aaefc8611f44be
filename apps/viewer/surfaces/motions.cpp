// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/motions.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "kontur/base/error.h"

namespace kontur::viewer {
namespace {

constexpr double kSpacingFraction = 0.0125;                 // of the contours' diameter: a triangle is some six pixels wide
constexpr std::size_t kMostBytes = std::size_t{256} << 20;  // of one structure's surfaces

std::size_t bytes_of(const MotionFrame& frame) {
    if (!frame.mesh) return 0;
    return 2 * frame.mesh->points.size() * sizeof(Vec3) +
           frame.mesh->triangles.size() * sizeof(frame.mesh->triangles.front());
}

std::size_t bytes_of(const Motion& motion) {
    return std::accumulate(motion.frames.begin(), motion.frames.end(), std::size_t{0},
                           [](std::size_t sum, const MotionFrame& frame) { return sum + bytes_of(frame); });
}

/// From 1, as contours have them.
std::vector<double> all_frames(int times) {
    std::vector<double> frames(static_cast<std::size_t>(times));
    std::iota(frames.begin(), frames.end(), 1);
    return frames;
}

std::map<int, std::vector<Contour>> sections_of(const std::vector<DrawnMoment>& moments) {
    std::map<int, std::vector<Contour>> sections;
    for (const DrawnMoment& moment : moments) {
        const std::vector<Contour>& all = moment.set.contours;
        sections[static_cast<int>(moment.time) - 1].assign(all.end() - static_cast<std::ptrdiff_t>(moment.carried),
                                                           all.end());
    }
    return sections;
}

/// As the mesh's time in `at`, between moments and seldom asked for.
double frame_number(int time) { return time + 1; }

}  // namespace

Motions::~Motions() {
    {
        const std::scoped_lock lock(mutex_);
        closed_.request_stop();
        stop_.request_stop();
        changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void Motions::stop_work_on(Id structure) {
    if (running_ && running_->structure == structure) stop_.request_stop();
}

void Motions::follow(MotionTask task) {
    const std::scoped_lock lock(mutex_);
    const Id structure = task.structure;
    stop_work_on(structure);
    KnownMotion& known = motions_[structure];
    known.meshes = nullptr;
    known.masks = nullptr;
    known.waiting = std::move(task);
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    changed_.notify_all();
}

void Motions::outdate(Id structure) {
    std::shared_ptr<const Motion> motion;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = motions_.find(structure);
        if (found == motions_.end()) return;
        stop_work_on(structure);
        KnownMotion& known = found->second;
        known.meshes = nullptr;
        known.masks = nullptr;
        known.waiting.reset();
        if (!known.latest || !known.latest->is_finished) return;
        Motion outdated = *known.latest;
        outdated.is_finished = false;
        known.latest = motion = std::make_shared<const Motion>(std::move(outdated));
    }
    listener_(motion);
}

void Motions::forget(Id structure) {
    {
        const std::scoped_lock lock(mutex_);
        if (!motions_.contains(structure)) return;
        stop_work_on(structure);
        motions_.erase(structure);
        changed_.notify_all();
    }
    auto none = std::make_shared<Motion>();
    none->structure = structure;
    listener_(none);
}

void Motions::look_at(int time) {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(looked_at_, time) != time) changed_.notify_all();
}

int Motions::looked_at() const {
    const std::scoped_lock lock(mutex_);
    return looked_at_;
}

std::shared_ptr<const Motion> Motions::of(Id structure) const {
    const std::scoped_lock lock(mutex_);
    const auto found = motions_.find(structure);
    return found == motions_.end() ? nullptr : found->second.latest;
}

std::map<Id, std::shared_ptr<const Motion>> Motions::all() const {
    const std::scoped_lock lock(mutex_);
    std::map<Id, std::shared_ptr<const Motion>> all;
    for (const auto& [id, known] : motions_)
        if (known.latest) all[id] = known.latest;
    return all;
}

void Motions::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !running_ && !next_step(); });
}

/// The time that is made next: that which is looked at, then those beside it. None where all there is room for is there.
std::optional<int> Motions::missing_time(const Motion& motion) const {
    std::optional<int> nearest;
    int farthest = 0;
    const auto away = [&](int time) { return std::abs(time - looked_at_); };
    for (int time = 0; time < static_cast<int>(motion.frames.size()); ++time) {
        const MotionFrame& frame = motion.frames[static_cast<std::size_t>(time)];
        if (frame.is_current) farthest = std::max(farthest, away(time));
        else if (!nearest || away(time) < away(*nearest)) nearest = time;
    }
    if (nearest && bytes_of(motion) > kMostBytes && away(*nearest) >= farthest) return std::nullopt;
    return nearest;
}

/// Under the lock.
std::optional<Motions::Step> Motions::next_step() const {
    for (const auto& [id, known] : motions_)
        if (known.waiting) return Step{Step::Kind::fit, id, 0};
    std::optional<Step> other;
    for (const auto& [id, known] : motions_) {
        if (!known.meshes) continue;
        const std::optional<int> time = missing_time(*known.latest);
        if (time == looked_at_) return Step{Step::Kind::mesh, id, *time};
        if (known.masks) other = Step{Step::Kind::volumes, id, 0};
        else if (time && !other) other = Step{Step::Kind::mesh, id, *time};
    }
    return other;
}

void Motions::run() {
    while (true) {
        StopSource stop;
        Step step;
        {
            std::unique_lock lock(mutex_);
            running_.reset();
            changed_.notify_all();
            changed_.wait(lock, [&] { return closed_.stop_requested() || next_step(); });
            if (closed_.stop_requested()) return;
            stop_ = stop;
            running_ = step = *next_step();
        }
        carry_out(step, stop.token());
    }
}

void Motions::carry_out(const Step& step, const StopToken& stop) {
    try {
        if (step.kind == Step::Kind::fit) fit(step.structure, stop);
        else if (step.kind == Step::Kind::mesh) add_mesh(step, stop);
        else add_volumes(step.structure, stop);
    } catch (const std::exception& error) {
        const auto* failure = dynamic_cast<const Error*>(&error);
        if (failure && failure->kind() == ErrorKind::cancelled) return;
        show(step.structure, stop, [&](KnownMotion& known, Motion& motion) {
            known.meshes = nullptr;
            known.masks = nullptr;
            motion.frames.assign(motion.frames.size(), {});
            motion.volumes.reset();
            motion.fit.reset();
            motion.meshes.reset();
            motion.sureness.reset();
            motion.warnings = {error.what()};
            motion.is_finished = true;
        });
    }
}

/// Changes what is shown and tells it, unless there are other contours already; false then.
bool Motions::show(Id structure, const StopToken& stop, const std::function<void(KnownMotion&, Motion&)>& change) {
    std::shared_ptr<const Motion> latest;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = motions_.find(structure);
        if (stop.stop_requested() || found == motions_.end()) return false;
        KnownMotion& known = found->second;
        Motion motion = known.latest ? *known.latest : Motion{};
        motion.structure = structure;
        change(known, motion);
        known.latest = latest = std::make_shared<const Motion>(std::move(motion));
    }
    listener_(latest);
    return true;
}

void Motions::fit(Id structure, const StopToken& stop) {
    std::optional<MotionTask> task;
    std::shared_ptr<MovingFitter> fitter;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = motions_.find(structure);
        if (found == motions_.end() || !found->second.waiting) return;
        KnownMotion& known = found->second;
        task = std::exchange(known.waiting, std::nullopt);
        const bool uses_image = static_cast<bool>(task->frames.image_at);
        if (!known.fitter || known.smoothing != task->smoothing || known.uses_image != uses_image) {
            known.fitter = std::make_shared<MovingFitter>(
                task->frames, SegmentOptions{.smoothing = task->smoothing, .drawn_on = task->frames.grid});
            known.smoothing = task->smoothing;
            known.uses_image = uses_image;
        }
        fitter = known.fitter;
        if (!known.latest || known.latest->frames.empty()) {
            Motion motion;
            motion.structure = structure;
            motion.frames.resize(static_cast<std::size_t>(task->times));
            known.latest = std::make_shared<const Motion>(std::move(motion));
        }
    }
    const Work work{.stop = stop};
    const auto fitted = std::make_shared<MovingFit>(fitter->fit(task->set, all_frames(task->times), work));
    const auto meshes = std::make_shared<const MeshCourse>(fitted->function, fitted->starts(),
                                                           kSpacingFraction * diameter_mm(task->set), work);
    const auto mask_course = std::make_shared<const MaskCourse>(fitted->mask_course(work));
    for (DrawnMoment& moment : fitted->moments) moment.segmentation.mask.values.clear();  // its grid alone is needed now
    show(structure, stop, [&](KnownMotion& known, Motion& motion) {
        known.meshes = meshes;
        known.masks = mask_course;
        for (MotionFrame& frame : motion.frames) frame.is_current = false;
        motion.fit = fitted;
        motion.meshes = meshes;
        motion.sureness.reset();
        motion.sections = sections_of(fitted->moments);
        motion.warnings = fitted->warnings;
        // The page asks for the cycle itself; the sentence names an option of the command line.
        std::erase_if(motion.warnings, [](const std::string& one) { return one.starts_with("nothing moves before"); });
        motion.is_finished = false;
    });
}

void Motions::add_mesh(const Step& step, const StopToken& stop) {
    std::shared_ptr<const MeshCourse> meshes;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = motions_.find(step.structure);
        if (found == motions_.end() || !found->second.meshes) return;
        meshes = found->second.meshes;
    }
    auto mesh = std::make_shared<const TriangleMesh>(meshes->at(frame_number(step.time)));
    const std::int64_t revision = next_revision_();
    show(step.structure, stop, [&](KnownMotion& known, Motion& motion) {
        motion.frames[static_cast<std::size_t>(step.time)] = {revision, std::move(mesh), true};
        give_up_far(motion);
        motion.is_finished = !known.masks && !missing_time(motion);
    });
}

void Motions::add_volumes(Id structure, const StopToken& stop) {
    std::shared_ptr<const MaskCourse> masks;
    std::shared_ptr<const Motion> latest;
    {
        const std::scoped_lock lock(mutex_);
        const auto found = motions_.find(structure);
        if (found == motions_.end() || !found->second.masks) return;
        masks = found->second.masks;
        latest = found->second.latest;
    }
    const auto times = static_cast<int>(latest->frames.size());
    const std::vector<DrawnMoment>& moments = latest->fit->moments;
    std::vector<double> volumes;
    for (int time = 0; time < times; ++time) {
        if (stop.stop_requested()) return;
        volumes.push_back(volume_ml(masks->at(frame_number(time))));
    }
    std::vector<VolumeInterval> intervals = volume_intervals(*masks, sureness_of(moments), all_frames(times), volumes);
    auto sureness = std::make_shared<const MovingSureness>(masks->course(), moments, Work{.stop = stop});
    show(structure, stop, [&](KnownMotion& known, Motion& motion) {
        known.masks = nullptr;
        motion.volumes = volume_curve(std::move(volumes), std::move(intervals));
        motion.sureness = std::move(sureness);
        motion.is_finished = !missing_time(motion);
    });
}

/// What lies farthest from where somebody looks, where all takes more memory than there is for it.
void Motions::give_up_far(Motion& motion) const {
    while (bytes_of(motion) > kMostBytes) {
        const auto away = [&](const MotionFrame& frame) {
            return frame.mesh ? std::abs(static_cast<int>(&frame - motion.frames.data()) - looked_at_) : -1;
        };
        const auto farthest = std::ranges::max_element(motion.frames, {}, away);
        if (away(*farthest) <= 0) return;
        *farthest = {};
    }
}

}  // namespace kontur::viewer
