// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/image_shares.h"

namespace kontur {

double ImageShares::at(const Vec3& p) const noexcept {
    double sum = 0, weights = 0;
    for (const AskedPoint& asked : asked_) {
        const Vec3 apart = p - asked.position;
        const double squared = dot(apart, apart);
        if (squared == 0) return asked.share;
        const double weight = 1 / (squared * squared);
        sum += weight * asked.share;
        weights += weight;
    }
    return weights > 0 ? sum / weights : 1;
}

}  // namespace kontur
