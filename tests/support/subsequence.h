// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur::test {

/// Whether all of `part` occurs in `whole`, in the same order.
inline bool is_subsequence(const std::vector<Vec3>& part, const std::vector<Vec3>& whole) {
    auto at = whole.begin();
    for (const Vec3& p : part) {
        at = std::find(at, whole.end(), p);
        if (at == whole.end()) return false;
        ++at;
    }
    return true;
}

}  // namespace kontur::test
