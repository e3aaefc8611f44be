// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kontur/shape/contour.h"

namespace kontur {

/// On which hand of an open contour that does not tell the object was taken to lie.
struct FoundSide {
    std::size_t contour = 0;
    Hand inside = Hand::left;
    bool is_sure = true;

    friend bool operator==(const FoundSide&, const FoundSide&) = default;
};

}  // namespace kontur
