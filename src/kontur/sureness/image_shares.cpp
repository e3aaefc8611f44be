// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/image_shares.h"

namespace kontur {

double ImageShares::at(const Vec3& p) const noexcept {
    double sum = 0, weights = 0;
    for (const ImageShare& image : shares_) {
        const Vec3 apart = p - image.position;
        const double squared = dot(apart, apart);
        if (squared == 0) return image.share;
        const double weight = 1 / (squared * squared);
        sum += weight * image.share;
        weights += weight;
    }
    return weights > 0 ? sum / weights : 1;
}

}  // namespace kontur
