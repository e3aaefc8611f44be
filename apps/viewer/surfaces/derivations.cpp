// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/derivations.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/derive/derived_surfaces.h"
#include "viewer/surfaces/surfaces.h"

namespace kontur::viewer {
namespace {

// Voxels that are looked at while a hand drags a line. A margin of 5 mm around a ball of 20 mm takes 9 ms with so many, and
// its volume is .8 % off; with half of them 6 ms (1.2 %), with twice as many 13 ms (.5 %).
constexpr std::int64_t kPreviewVoxels = 100'000;
// When the hand rests: the image's own, as long as their levels, of which there are some at a time, take 160 MB each.
constexpr std::int64_t kFinishedVoxels = 40'000'000;

Surface no_surface(Id structure, std::string why) {
    Surface none;
    none.structure = structure;
    none.is_derived = true;
    if (!why.empty()) none.warnings.push_back(std::move(why));
    return none;
}

const Surface* surface_of(const Derivations::Surfaces& surfaces, Id structure) {
    const auto found = surfaces.find(structure);
    return found == surfaces.end() || !found->second->mesh ? nullptr : found->second.get();
}

/// What the rules need besides each other, as it is seen just now.
std::vector<ShownStructure> sources_of(const RuleMembers& members, const Derivations::Surfaces& surfaces) {
    std::vector<ShownStructure> sources;
    for (const auto& [name, id] : members.drawn) {
        const Surface& surface = *surface_of(surfaces, id);
        sources.push_back({name, surface.mesh, surface.function});
    }
    return sources;
}

/// Why the rule cannot be followed; "" where it can.
std::string missing(const RuleTask& task, const Derivations::Surfaces& surfaces) {
    if (!task.problem.empty()) return task.problem;
    for (const auto& [name, id] : task.members.drawn)
        if (!surface_of(surfaces, id)) return fmt::format("There is no surface of {} yet.", name);
    return "";
}

bool are_finished(const RuleMembers& members, const Derivations::Surfaces& surfaces) {
    return std::ranges::all_of(members.drawn, [&](const auto& item) {
        const Surface* const surface = surface_of(surfaces, item.second);
        return surface && has_full_resolution(surface->stage);
    });
}

/// What tells whether it would be made the same again.
std::vector<std::string> revisions_of(const RuleMembers& members, const Derivations::Surfaces& surfaces) {
    std::vector<std::string> all = members.rules;
    for (const auto& [name, id] : members.drawn)
        all.push_back(fmt::format("{} {}", name, surface_of(surfaces, id)->revision));
    return all;
}

/// Says at its end that nothing is done any more.
class StatusOfWork {
public:
    explicit StatusOfWork(Derivations::StatusListener listener) : listener_(std::move(listener)) {}
    ~StatusOfWork() { tell(std::nullopt); }
    StatusOfWork(const StatusOfWork&) = delete;
    StatusOfWork& operator=(const StatusOfWork&) = delete;

    void tell(std::optional<double> done) const {
        if (listener_) listener_(done);
    }

private:
    const Derivations::StatusListener listener_;
};

/// All that takes part in making any of these.
RuleMembers together(const std::map<Id, RuleTask>& tasks) {
    RuleMembers all;
    for (const auto& [id, task] : tasks) all.add(task.members);
    return all;
}

}  // namespace

Derivations::Derivations(Sources sources, Listener listener, StatusListener status, std::shared_ptr<BodyOutlines> bodies)
    : sources_(std::move(sources)), listener_(std::move(listener)), status_(std::move(status)), bodies_(std::move(bodies)) {}

Derivations::~Derivations() {
    {
        const std::scoped_lock lock(mutex_);
        is_ending_ = true;
        stop_.request_stop();
        changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
}

void Derivations::follow(RuleTask task) {
    const std::scoped_lock lock(mutex_);
    const Id structure = task.members.derived.front();
    tasks_.insert_or_assign(structure, std::move(task));
    begin_locked({structure});
}

void Derivations::forget(Id structure) {
    const std::scoped_lock lock(mutex_);
    tasks_.erase(structure);
    outdated_.erase(structure);
}

void Derivations::heard(Id structure) {
    const std::scoped_lock lock(mutex_);
    if (tasks_.contains(structure)) return;  // it is made together with what is made of it
    std::set<Id> users;
    for (const auto& [id, task] : tasks_)
        if (std::ranges::any_of(task.members.drawn, [&](const auto& item) { return item.second == structure; }))
            users.insert(id);
    if (!users.empty()) begin_locked(users);
}

bool Derivations::makes(Id structure) const {
    const std::scoped_lock lock(mutex_);
    return tasks_.contains(structure);
}

std::set<Id> Derivations::made_of(const std::set<Id>& structures) const {
    const std::scoped_lock lock(mutex_);
    std::set<Id> users;
    for (const auto& [id, task] : tasks_) {
        const RuleMembers& members = task.members;
        if (std::ranges::any_of(members.drawn, [&](const auto& item) { return structures.contains(item.second); }) ||
            std::ranges::any_of(members.derived, [&](Id member) { return structures.contains(member); }))
            users.insert(id);
    }
    return users;
}

/// A preview runs to its end, so that surfaces keep coming while a hand drags a line.
void Derivations::begin_locked(const std::set<Id>& structures) {
    outdated_.insert(structures.begin(), structures.end());
    if (!is_preview_) stop_.request_stop();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    changed_.notify_all();
}

void Derivations::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        is_working_ = false;
        changed_.notify_all();
        changed_.wait(lock, [&] { return is_ending_ || !outdated_.empty(); });
        if (is_ending_) return;
        Tasks tasks;
        for (const Id id : std::exchange(outdated_, {}))
            if (const auto found = tasks_.find(id); found != tasks_.end()) tasks.insert(*found);
        is_working_ = true;
        stop_ = StopSource();
        const StopToken stop = stop_.token();
        lock.unlock();
        make(tasks, stop);
        lock.lock();
        // What was stopped is made with what stopped it.
        if (stop.stop_requested())
            for (const auto& [id, task] : tasks)
                if (tasks_.contains(id)) outdated_.insert(id);
        is_preview_ = false;
    }
}

bool Derivations::is_newest(Id structure) const {
    const std::scoped_lock lock(mutex_);
    return !outdated_.contains(structure);
}

void Derivations::make(const Tasks& tasks, const StopToken& stop) {
    const Surfaces surfaces = sources_();
    Tasks possible;
    for (const auto& [id, task] : tasks) {
        if (show_again(task.members, surfaces)) continue;
        const std::string why = missing(task, surfaces);
        if (why.empty()) possible.insert({id, task});
        else listener_(no_surface(id, why));
    }
    if (!possible.empty()) make_all(possible, surfaces, stop);
}

/// Whether it has been made of the same surfaces: they were only on their way, or come back by undo.
bool Derivations::show_again(const RuleMembers& members, const Surfaces& surfaces) {
    const Id id = members.derived.front();
    const auto known = made_of_.find(id);
    const Surface* const last = surface_of(surfaces, id);
    if (!last || known == made_of_.end() || !are_finished(members, surfaces) ||
        known->second != revisions_of(members, surfaces))
        return false;
    if (last->stage == SurfaceStage::finished) return true;
    Surface again = *last;
    again.stage = SurfaceStage::finished;
    listener_(std::move(again));
    return true;
}

/// One rule that cannot be followed does not keep the others from being.
void Derivations::make_all(const Tasks& tasks, const Surfaces& surfaces, const StopToken& stop) {
    std::string why;
    try {
        return make_together(tasks, surfaces, stop);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) return;
        why = error.what();
    } catch (const std::exception& error) {
        why = fmt::format("It could not be made: {}.", error.what());
    }
    if (tasks.size() == 1) return listener_(no_surface(tasks.begin()->first, why));
    for (const auto& one : tasks) make_all(Tasks{one}, surfaces, stop);
}

void Derivations::make_together(const Tasks& tasks, const Surfaces& surfaces, const StopToken& stop) {
    const RuleMembers members = together(tasks);
    const bool is_finished = are_finished(members, surfaces);
    {
        const std::scoped_lock lock(mutex_);
        is_preview_ = !is_finished;
    }
    const std::vector<TriangleMesh> derived = meshes(members, surfaces, tasks.begin()->second.image, stop);
    const bool is_current = is_finished && are_finished(members, sources_());
    for (const auto& [id, task] : tasks) {
        const auto at = static_cast<std::size_t>(std::ranges::find(members.derived, id) - members.derived.begin());
        Surface surface = no_surface(id, derived[at].triangles.empty() ? "The rule leaves nothing." : "");
        if (!derived[at].triangles.empty()) {
            surface.mesh = std::make_shared<const TriangleMesh>(derived[at]);
            surface.volume_ml = signed_volume_mm3(*surface.mesh) / 1000;
            surface.stage = is_current && is_newest(id) ? SurfaceStage::finished : SurfaceStage::preview;
        }
        if (is_finished) made_of_[id] = revisions_of(task.members, surfaces);
        else made_of_.erase(id);
        listener_(std::move(surface));
    }
}

std::vector<TriangleMesh> Derivations::meshes(const RuleMembers& members, const Surfaces& surfaces,
                                              const std::shared_ptr<const Image>& image, const StopToken& stop) {
    const bool is_finished = are_finished(members, surfaces);
    DerivedSurfacesOptions options{image->grid, is_finished ? kFinishedVoxels : kPreviewVoxels};
    options.body = [&](const std::optional<double>& threshold) { return bodies_->at(*image, threshold, {.stop = stop}); };
    const StatusOfWork status{is_finished ? status_ : StatusListener()};
    const Work work{.callback = [&](std::string_view, double done) { status.tell(done); }, .stop = stop};
    return derived_surfaces(members.rules, sources_of(members, surfaces), options, work);
}

TriangleMesh Derivations::preview(const RuleTask& task) {
    const Surfaces surfaces = sources_();
    if (const std::string why = missing(task, surfaces); !why.empty()) throw Error(ErrorKind::invalid_input, why);
    return meshes(task.members, surfaces, task.image, {}).front();
}

void Derivations::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return outdated_.empty() && !is_working_; });
}

}  // namespace kontur::viewer
