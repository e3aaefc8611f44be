// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kontur/base/error.h"
#include "viewer/files/export_fits.h"
#include "viewer/images/further_image.h"
#include "viewer/images/project_image.h"
#include "viewer/session/edges_in_time.h"
#include "viewer/session/pages.h"
#include "viewer/session/watched_planes.h"
#include "viewer/store/project.h"
#include "viewer/surfaces/body_outlines.h"
#include "viewer/surfaces/surfaces.h"

namespace kontur::viewer {

/// Of an open page; 0: of nobody.
using PageId = std::uint64_t;

/// There was a structure with this id.
class StructureRemoved : public Error {
public:
    using Error::Error;
};

/// What the moving hand shows, before it is a step of the history.
struct Draft {
    DrawnContour contour;               ///< stands for the contour with its id, or is a new one (id 0)
    std::vector<DrawnContour> carried;  ///< neighbours' contours that go with it, in place of those with their ids
    PageId owner = 0;
};

/// The image that is shown beside the project's own; null while there is none. Safe for concurrent use.
class SecondImage {
public:
    std::shared_ptr<const FurtherImage> get() const {
        const std::scoped_lock lock(mutex_);
        return shown_;
    }
    void set(std::shared_ptr<const FurtherImage> second) {
        const std::scoped_lock lock(mutex_);
        shown_ = std::move(second);
    }

private:
    mutable std::mutex mutex_;
    std::shared_ptr<const FurtherImage> shown_;
};

/// What the calls of pages work on: image, project, surfaces, and whom to tell. Those that change the project hold `mutex`;
/// all above it is safe for concurrent use by itself.
struct SessionState {
    /// Throws as Project does, and Error(invalid_input) where the project was drawn on another image.
    SessionState(OpenedImage opened, const std::filesystem::path& path);

    /// The project's present state; locks.
    State state() const;
    /// The structure; throws StructureRemoved, or as `structure_of` for an id that none can have had. Locks.
    const Structure& present_structure(const State& now, Id id) const;
    /// Of the volume that the contour was drawn in.
    std::shared_ptr<SliceEdges> edges_of(const DrawnContour& contour) {
        return edges.at(contour.time.value_or(image.times.own()));
    }

    std::shared_ptr<BodyOutlines> bodies = std::make_shared<BodyOutlines>();  ///< in the image
    ProjectImage image;
    EdgesInTime edges;
    ExportFits fits;
    Pages pages;
    WatchedPlanes watched;
    SecondImage second;

    mutable std::mutex mutex;  ///< of what follows
    std::vector<std::string> notes;
    Project project;
    std::optional<Draft> draft;
    std::set<Id> edited_since_borders;     ///< structures that may touch others for the first time
    std::vector<BorderPair> border_pairs;  ///< as they were last found
    std::uint64_t steps = 0;               ///< made, undone and made again since the session began
    PageId caller = 0;                     ///< whose call is carried out

    Surfaces surfaces;  ///< last: its threads tell events
};

}  // namespace kontur::viewer
