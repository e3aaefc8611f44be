// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"

namespace kontur {

/// Where the image was asked: around each point of a surface as far as offsets were searched there. Nothing is known of what
/// lies beyond, so no surface that follows the image may go there.
class SearchedBand {
public:
    /// `surface`: points of it, mm, close together; `reach_mm` of each.
    SearchedBand(std::vector<Vec3> surface, std::vector<double> reach_mm);

    /// From which points of the surface another one, given by points as close together, runs out of the band, or no longer
    /// passes within it.
    std::vector<Vec3> left_from(std::span<const Vec3> other, const Work& work = {}) const;

private:
    std::vector<Vec3> surface_;
    std::vector<double> reach_mm_;
};

}  // namespace kontur
