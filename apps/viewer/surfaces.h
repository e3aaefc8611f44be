// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "kontur/field/residual.h"
#include "kontur/shape/mesh.h"
#include "viewer/model.h"

namespace kontur::viewer {

enum class SurfaceStage { none, preview, refined };
std::string_view name(SurfaceStage stage) noexcept;

/// What is shown of a structure's surface.
struct Surface {
    Id structure = 0;
    std::int64_t revision = 0;
    SurfaceStage stage = SurfaceStage::none;
    std::shared_ptr<const TriangleMesh> mesh;  ///< null for `none`
    // Known when refined:
    double volume_ml = 0;
    Residual residual;
    Id worst_contour = 0;  ///< where the residual is largest
    Vec3 worst_at;
    std::vector<std::string> warnings;
};

/// The contours a surface is made of; `ids[i]` names `set.contours[i]`.
struct SurfaceTask {
    Id structure = 0;
    ContourSet set;
    std::vector<Id> ids;
};

struct SurfaceListener {
    std::function<void(std::shared_ptr<const Surface>)> surface;
    std::function<void(const std::string& text)> status;  ///< what is being computed; empty when idle
};

/// Makes surfaces on a thread of its own: at once a coarse one, then, when no newer task has come for the moment that a hand
/// rests, the fine one. A newer task of the same structure replaces a waiting one and cancels a running one. The listener is
/// called from that thread.
class Surfaces {
public:
    explicit Surfaces(SurfaceListener listener);
    ~Surfaces();
    Surfaces(const Surfaces&) = delete;
    Surfaces& operator=(const Surfaces&) = delete;

    void follow(SurfaceTask task);
    /// Waits until nothing is left to do.
    void wait();

    /// The last surface of every structure that has had one.
    std::map<Id, std::shared_ptr<const Surface>> all() const;

private:
    struct Pending {
        SurfaceTask task;
        SurfaceStage next = SurfaceStage::preview;
    };

    void work(const std::stop_token& stop);
    std::optional<Pending> take(const std::stop_token& stop);
    void make(const Pending& job, const std::stop_token& stop);
    void publish(Surface surface);

    SurfaceListener listener_;
    mutable std::mutex mutex_;
    std::condition_variable_any wake_, idle_;
    std::map<Id, Pending> pending_;
    std::map<Id, std::shared_ptr<const Surface>> latest_;
    Id running_ = 0;  ///< the structure being computed; 0: none
    std::stop_source cancel_;
    std::int64_t revision_ = 0;
    std::jthread worker_;  ///< last: it uses everything above
};

}  // namespace kontur::viewer
