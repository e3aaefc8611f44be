// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/contour.h"
#include "kontur/sureness/image_shares.h"

namespace kontur {

/// What the image said of a drawing, for the time until it has been asked about the edited one: the border that it showed
/// is still there.
class AskedBefore {
public:
    AskedBefore() = default;
    AskedBefore(ContourSet contours, std::vector<AskedPoint> asked)
        : contours_(std::move(contours)), asked_(std::move(asked)) {}

    /// Places, mm, at which the image showed the surface of the drawing and, as far as can be told, shows that of an edited
    /// one: those nearer to a contour that is still the same than to any that came, went or changed.
    std::vector<Vec3> still_shown(const ContourSet& edited) const;

private:
    ContourSet contours_;
    std::vector<AskedPoint> asked_;
};

}  // namespace kontur
