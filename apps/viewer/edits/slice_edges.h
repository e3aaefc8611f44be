// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "kontur/shape/volume.h"
#include "kontur/view/livewire.h"
#include "kontur/view/reslice.h"

namespace kontur::viewer {

/// Edge-following paths on slices of a project's images, which have numbers from 0. The slice of a plane is sampled at the
/// image's resolution, whatever part of it a view shows, so that a path does not depend on zoom; the last slices and seeds
/// are kept. A number that no image has (any more) stands for the first one. Safe for concurrent use.
class SliceEdges {
public:
    explicit SliceEdges(std::shared_ptr<const Image> image);
    ~SliceEdges();

    /// A further image, in place of one that has this number; null: there is none any more. `image` is at least 1.
    void set_further(int image, std::shared_ptr<const Image> further);

    /// Along the edges of the plane's slice, from `from` (included) to `to` (left out), in mm on the plane.
    std::vector<Vec3> path(const Plane& plane, const Vec3& from, const Vec3& to, int image = 0);

    /// The clearest edge point within `radius_mm` (at least one pixel, at most 20) of the point.
    Vec3 snap(const Plane& plane, const Vec3& point, double radius_mm, int image = 0);

private:
    struct Slice;
    Slice& slice_of(const Plane& plane, const Vec3& point, int image);

    std::map<int, std::shared_ptr<const Image>> images_;
    std::mutex mutex_;
    std::list<Slice> slices_;  ///< the last used first
};

}  // namespace kontur::viewer
