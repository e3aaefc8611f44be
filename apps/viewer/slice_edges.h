// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "kontur/shape/volume.h"
#include "kontur/view/livewire.h"
#include "kontur/view/reslice.h"

namespace kontur::viewer {

/// Edge-following paths on slices of one image. The slice of a plane is sampled at the image's resolution, whatever part of
/// it a view shows, so that a path does not depend on zoom; the last slices and seeds are kept. Safe for concurrent use.
class SliceEdges {
public:
    explicit SliceEdges(std::shared_ptr<const Image> image);
    ~SliceEdges();

    /// Along the edges of the plane's slice, from `from` (included) to `to` (left out), in mm on the plane.
    std::vector<Vec3> path(const Plane& plane, const Vec3& from, const Vec3& to);

    /// The clearest edge point within `radius_mm` (at least one pixel, at most 20) of the point.
    Vec3 snap(const Plane& plane, const Vec3& point, double radius_mm);

private:
    struct Slice;
    Slice& slice_of(const Plane& plane, const Vec3& point);

    std::shared_ptr<const Image> image_;
    double pixel_mm_;
    std::mutex mutex_;
    std::list<Slice> slices_;  ///< the last used first
};

}  // namespace kontur::viewer
