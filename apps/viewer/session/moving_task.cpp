// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/moving_task.h"

#include <algorithm>

#include "kontur/base/error.h"
#include "kontur/moving/carried_sections.h"
#include "kontur/view/outline.h"
#include "viewer/edits/sketch.h"
#include "viewer/session/events.h"

namespace kontur::viewer {
namespace {

int time_at_hand(const std::vector<int>& times, int looked_at) {
    return *std::ranges::min_element(times, {}, [&](int time) { return std::abs(time - looked_at); });
}

/// In planes that were drawn at other times alone: none where most were drawn at this one, too.
std::vector<Plane> missing_planes(const ContourSet& moving, int time) {
    try {
        const DrawnMoments drawn = drawn_moments(moving, moments_of(moving));
        const auto& moments = drawn.moments.course.times();
        const auto at = std::ranges::find(moments, static_cast<double>(time + 1));
        const auto k = static_cast<std::size_t>(at - moments.begin());
        return at == moments.end() || drawn.weights[k] == 1 ? std::vector<Plane>{} : drawn.missing[k];
    } catch (const Error&) {
        return {};  // the motion says why there is none
    }
}

/// What was carried there from other times, or else what is seen there now.
std::vector<Contour> stand_ins(const SurfaceTask& task, SessionState& s) {
    std::vector<Contour> found;
    const auto motion = s.surfaces.motions().of(task.structure);
    std::vector<Contour> carried;
    if (motion)
        if (const auto at = motion->sections.find(task.time); at != motion->sections.end()) carried = at->second;
    const auto seen = s.surfaces.at(task.time);
    const auto own = seen.find(task.structure);
    for (const Plane& plane : missing_planes(task.motion->set, task.time)) {
        const std::size_t before = found.size();
        std::ranges::copy_if(carried, std::back_inserter(found),
                             [&](const Contour& contour) { return is_same_plane(contour.plane, plane); });
        if (found.size() > before || own == seen.end() || !own->second.mesh) continue;
        for (const Polyline& line : outline(*own->second.mesh, plane)) {
            Contour contour{.plane = plane, .points = thinned(line.points)};
            if (!contour_problem(contour, "a section")) found.push_back(std::move(contour));
        }
    }
    return found;
}

}  // namespace

void turn_into_motion(SurfaceTask& task, const std::vector<int>& times, SessionState& s) {
    ContourSet all = task.set;
    set_frames(all, times, s.project.state());
    task.time = time_at_hand(times, s.surfaces.motions().looked_at());
    FramesToSegment frames(s.image.voxels->grid);
    if (image_for_fits(s))
        frames.image_at = [&volumes = s.image.times](double frame) { return volumes.image(static_cast<int>(frame) - 1); };
    task.motion = MotionTask{task.structure, std::move(all), s.image.times.count(), std::move(frames), task.smoothing};
    const std::vector<Contour> contours = std::exchange(task.set.contours, {});
    const std::vector<Id> ids = std::exchange(task.ids, {});
    for (std::size_t n = 0; n < contours.size(); ++n) {
        if (times[n] != task.time) continue;
        task.set.contours.push_back(contours[n]);
        task.ids.push_back(ids[n]);
    }
    for (Contour& contour : stand_ins(task, s)) {
        task.set.contours.push_back(std::move(contour));
        task.ids.push_back(0);
    }
}

}  // namespace kontur::viewer
