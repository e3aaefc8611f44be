// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace kontur {

/// Two closed contours of one plane so near to each other that they may be one line, drawn twice.
struct NearLines {
    std::size_t contour = 0, other = 0;  ///< `contour` lies inside `other`, or they cross and it is the first
    double apart_mm = 0;                 ///< on average
    double share = 0;                    ///< what lies between them, of what the larger one encloses
    bool are_nested = false;
    bool is_one = false;  ///< taken for one line; otherwise the inner one is a hole

    friend bool operator==(const NearLines&, const NearLines&) = default;
};

}  // namespace kontur
