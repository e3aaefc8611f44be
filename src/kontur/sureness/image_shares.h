// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// A place of the surface at which the image was asked.
struct AskedPoint {
    Vec3 position;     ///< mm, where the image moved it to
    double share = 1;  ///< of the error without the image that it leaves: standard deviations of the offset, 0 to 1
};

/// What share of the contours' own uncertainty is left at any place, where the image told how the surface runs: the mean of
/// the points asked, weighted by the inverse fourth power of their distance. 1 everywhere where none was.
class ImageShares {
public:
    ImageShares() = default;
    explicit ImageShares(std::vector<AskedPoint> asked) : asked_(std::move(asked)) {}

    bool is_empty() const { return asked_.empty(); }
    double at(const Vec3& p) const noexcept;

private:
    std::vector<AskedPoint> asked_;
};

}  // namespace kontur
