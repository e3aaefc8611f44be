// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "kontur/base/stop.h"
#include "kontur/moving/mesh_course.h"
#include "kontur/moving_sureness.h"
#include "kontur/segment_moving.h"
#include "viewer/model/model.h"

namespace kontur::viewer {

/// A structure's surface at one time of the image.
struct MotionFrame {
    std::int64_t revision = 0;  ///< 0: there is none yet
    std::shared_ptr<const TriangleMesh> mesh;
    bool is_current = false;  ///< false: of the contours of before
};

/// A structure at all times of the image, as far as it has been made.
struct Motion {
    Id structure = 0;
    std::vector<MotionFrame> frames;     ///< by time, from 0; none: the structure moves no more
    std::optional<VolumeCurve> volumes;  ///< of the masks at these times, as `kontur segment` makes them
    bool is_finished = false;            ///< all of it is of the present contours
    std::vector<std::string> warnings;   ///< of the fit, or why there is none
    /// Stand for contours where little was drawn, by time: sections in planes that were drawn at other times.
    std::map<int, std::vector<Contour>> sections;
    std::shared_ptr<const MovingFit> fit;            ///< that all of this is of, without its moments' voxels
    std::shared_ptr<const MeshCourse> meshes;        ///< of the fit
    std::shared_ptr<const MovingSureness> sureness;  ///< of the fit, with the volumes
};

/// What a motion is made of.
struct MotionTask {
    Id structure = 0;
    ContourSet set;  ///< with their frames
    int times = 1;   ///< that the image has
    FramesToSegment frames;
    std::optional<double> smoothing{};
};

/// Makes structures that move at all times of the image, on a thread of its own: first where somebody looks, then the
/// volumes, then the times beside it. New contours give up what is being made; what was shown of the contours before stays
/// until there is something new. Surfaces take a bounded amount of memory: those that lie far from where somebody looks go
/// first. Safe for concurrent use.
class Motions {
public:
    using Listener = std::function<void(const std::shared_ptr<const Motion>&)>;

    /// `next_revision` and the listener are called from the thread, and must not call Motions.
    Motions(std::function<std::int64_t()> next_revision, Listener listener)
        : next_revision_(std::move(next_revision)), listener_(std::move(listener)) {}
    ~Motions();
    Motions(const Motions&) = delete;
    Motions& operator=(const Motions&) = delete;

    /// The structure's contours are now these. Does not wait.
    void follow(MotionTask task);
    /// There will be other contours: what is being made for it is given up.
    void outdate(Id structure);
    /// It does not move, or is not there any more.
    void forget(Id structure);
    /// This time is looked at.
    void look_at(int time);
    int looked_at() const;

    /// The structure's motion; null: it has none.
    std::shared_ptr<const Motion> of(Id structure) const;
    std::map<Id, std::shared_ptr<const Motion>> all() const;
    /// Waits until all there is to be made has been made.
    void wait();

private:
    struct KnownMotion {
        std::shared_ptr<const Motion> latest;
        std::shared_ptr<const MeshCourse> meshes;  ///< of the contours of now; null: nothing more can be made
        std::shared_ptr<const MaskCourse> masks;   ///< until the volumes are known
        std::shared_ptr<MovingFitter> fitter;
        std::optional<double> smoothing;  ///< of the fitter,
        bool uses_image = false;          ///< likewise
        std::optional<MotionTask> waiting;
    };
    /// What is to be done next for a structure.
    struct Step {
        enum class Kind { fit, mesh, volumes } kind = Kind::fit;
        Id structure = 0;
        int time = 0;  ///< of a mesh
    };

    void run();
    std::optional<Step> next_step() const;
    std::optional<int> missing_time(const Motion& motion) const;
    void carry_out(const Step& step, const StopToken& stop);
    void fit(Id structure, const StopToken& stop);
    void add_mesh(const Step& step, const StopToken& stop);
    void add_volumes(Id structure, const StopToken& stop);
    void give_up_far(Motion& motion) const;
    void stop_work_on(Id structure);
    bool show(Id structure, const StopToken& stop, const std::function<void(KnownMotion&, Motion&)>& change);

    const std::function<std::int64_t()> next_revision_;
    const Listener listener_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<Id, KnownMotion> motions_;
    int looked_at_ = 0;
    std::optional<Step> running_;
    StopSource closed_, stop_;
    std::thread thread_;  ///< last: it uses all above
};

}  // namespace kontur::viewer
