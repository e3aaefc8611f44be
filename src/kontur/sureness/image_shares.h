// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/sureness/image_share.h"

namespace kontur {

/// What share of the contours' own uncertainty is left at any place, where the image told how the surface runs: the mean of
/// the points asked, weighted by the inverse fourth power of their distance. 1 everywhere where none was.
class ImageShares {
public:
    ImageShares() = default;
    explicit ImageShares(std::vector<ImageShare> shares) : shares_(std::move(shares)) {}

    bool is_empty() const { return shares_.empty(); }
    double at(const Vec3& p) const noexcept;

private:
    std::vector<ImageShare> shares_;
};

}  // namespace kontur
