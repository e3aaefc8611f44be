// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/surfaces.h"

// What is seen of structures at each time of the image.

namespace kontur::viewer {

std::map<Id, ShownSurface> Surfaces::at(int time) const {
    std::map<Id, ShownSurface> all;
    const auto motions = motions_.all();
    for (const auto& [id, surface] : this->all()) {
        ShownSurface& surface_now = all[id] = {surface->revision, surface->stage, surface->mesh, surface->without_image};
        const auto found = motions.find(id);
        if (found == motions.end() || time >= static_cast<int>(found->second->frames.size())) continue;
        const Motion& motion = *found->second;
        const MotionFrame& frame = motion.frames[static_cast<std::size_t>(time)];
        // What the hand shows of this time may be newer; of another time it is no more than better than nothing.
        if (!frame.mesh || (surface->time == time && surface->revision > frame.revision)) continue;
        surface_now = {frame.revision, motion.is_finished ? SurfaceStage::finished : SurfaceStage::preview, frame.mesh,
                       nullptr};
    }
    return all;
}

std::shared_ptr<const Image> Surfaces::image_of(const SurfaceTask& task) const {
    if (task.motion) return nullptr;
    return task.image.value_or(image_);
}

}  // namespace kontur::viewer
