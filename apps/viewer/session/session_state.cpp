// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/session_state.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "viewer/session/events.h"
#include "viewer/session/history.h"
#include "viewer/session/reviews.h"

namespace kontur::viewer {
namespace {

/// Tells pages what becomes of the surfaces.
SurfaceListener surface_listener(SessionState& s) {
    return {[&s](Id structure, std::int64_t revision, const PlaneCutters& cut) {
                s.pages.tell(outlines_event(s.watched.all(), structure, revision, cut));
            },
            [&s](const std::shared_ptr<const Surface>& surface) { s.pages.tell(surface_event(s, *surface)); },
            s.pages.status_teller(),
            [&s](const std::vector<BorderPair>& pairs, const std::string& problem) {
                try {
                    take_approvals_back(s, pairs);
                } catch (const std::exception& error) {
                    s.pages.notice("error", error.what());
                }
                if (!problem.empty())
                    s.pages.notice("warning", fmt::format("Structures share no borders here: {}", problem));
                s.pages.tell({{"event", "borders"}, {"pairs", to_json(pairs)}});
            },
            [&s](const std::shared_ptr<const Motion>& motion) { s.pages.tell(motion_event(*motion)); }};
}

}  // namespace

SessionState::SessionState(OpenedImage opened, const std::filesystem::path& path)
    : image(opened),
      edges(image.times),
      fits(
          image.voxels, [this](int time) { return image.times.image(time); }, image.times.count(), bodies),
      notes(std::move(opened.notes)),
      project(path, opened.reference),
      surfaces(surface_listener(*this), bodies) {
    if (const ImageReference& known = project.image(); known.fingerprint != opened.reference.fingerprint)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("{} was drawn on another image ({}) than {}", path.string(), known.path, image.title));
    if (project.is_read_only())
        notes.push_back(
            fmt::format("{} can only be read here, so nothing can be drawn or changed. To go on from it save a "
                        "copy where you can write: Export, Project.",
                        path.filename().string()));
    else if (project.image().path != opened.reference.path || project.image().choice != opened.reference.choice)
        project.save_image(opened.reference);
    project.set_times(image.times.own(), image.cycle_frames);
    surfaces.motions().look_at(image.times.own());
    surfaces.use_image(image_for_fits(*this));
    surfaces.share_borders(project.state().borders);
    for (const auto& [id, structure] : project.state().structures) surfaces.follow_later(surface_task(*this, id));
}

State SessionState::state() const {
    const std::scoped_lock lock(mutex);
    return project.state();
}

const Structure& SessionState::present_structure(const State& now, Id id) const {
    const std::scoped_lock lock(mutex);
    if (!now.structures.contains(id) && project.has_given(id))
        throw StructureRemoved(ErrorKind::invalid_input, fmt::format("the structure with the id {} has been removed", id));
    return structure_of(now, id);
}

}  // namespace kontur::viewer
