// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
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
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"
#include "viewer/model/structure_rules.h"
#include "viewer/surfaces/body_outlines.h"

namespace kontur::viewer {

struct Surface;

/// A structure that a rule makes.
struct RuleTask {
    RuleMembers members;                 ///< the structure first
    std::shared_ptr<const Image> image;  ///< on whose voxels it is made
    std::string problem{};               ///< why it cannot be made; "" where nothing is known against it
};

/// Works rules out on a thread of its own, whenever a surface of what they name has changed: while a hand drags a line on
/// larger voxels, with the image's own as soon as that surface is finished. Safe for concurrent use.
class Derivations {
public:
    using Surfaces = std::map<Id, std::shared_ptr<const Surface>>;
    using Sources = std::function<Surfaces()>;
    using Listener = std::function<void(Surface)>;
    using StatusListener = std::function<void(std::optional<double> done)>;

    /// All three are called from the thread, without a lock; they may call all of this but `wait`. The status is how much
    /// has been done; nothing when nothing is being done any more.
    Derivations(Sources sources, Listener listener, StatusListener status, std::shared_ptr<BodyOutlines> bodies);
    ~Derivations();
    Derivations(const Derivations&) = delete;
    Derivations& operator=(const Derivations&) = delete;

    /// The structure is made so from now on. Does not wait.
    void follow(RuleTask task);
    /// No rule makes it any more.
    void forget(Id structure);
    /// A structure has another surface. Does not wait.
    void heard(Id structure);
    bool makes(Id structure) const;
    /// Those that rules make of any of these.
    std::set<Id> made_of(const std::set<Id>& structures) const;
    /// What the rule would make just now. Throws Error(invalid_input) where there is no surface of something that it needs.
    TriangleMesh preview(const RuleTask& task);
    /// Waits until all is worked out.
    void wait();

private:
    using Tasks = std::map<Id, RuleTask>;

    void begin_locked(const std::set<Id>& structures);
    void run();
    void make(const Tasks& tasks, const StopToken& stop);
    void make_all(const Tasks& tasks, const Surfaces& surfaces, const StopToken& stop);
    void make_together(const Tasks& tasks, const Surfaces& surfaces, const StopToken& stop);
    bool show_again(const RuleMembers& members, const Surfaces& surfaces);
    std::vector<TriangleMesh> meshes(const RuleMembers& members, const Surfaces& surfaces,
                                     const std::shared_ptr<const Image>& image, const StopToken& stop);
    bool is_newest(Id structure) const;

    const Sources sources_;
    const Listener listener_;
    const StatusListener status_;
    const std::shared_ptr<BodyOutlines> bodies_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    Tasks tasks_;
    std::set<Id> outdated_;
    bool is_working_ = false, is_preview_ = false, is_ending_ = false;
    StopSource stop_;
    std::map<Id, std::vector<std::string>> made_of_;  ///< of the thread: rules and revisions of what was finished last
    std::thread thread_;                              ///< last: it uses all above
};

}  // namespace kontur::viewer
