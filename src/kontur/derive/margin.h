// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"

namespace kontur {

/// How far each side of a structure moves, mm, not below 0.
struct SideLengths {
    double left = 0, right = 0, anterior = 0, posterior = 0, superior = 0, inferior = 0;

    bool are_alike() const {
        return left == right && left == anterior && left == posterior && left == superior && left == inferior;
    }
    double largest() const;
};

enum class MarginSide { outwards, inwards };

/// All points up to so far from the structure; inwards, those of the structure at least so far from its surface. With
/// several lengths the ball around each point becomes a body of eight octants of ellipsoids with these half axes. What lies
/// inside the structure stays inside outwards, also at a length of 0, and inwards nothing is added.
Levels margin(const Levels& levels, const Grid& grid, const SideLengths& lengths, MarginSide side, const Work& work);

/// What the structure passes when it moves by this vector (mm); inwards, the points that stay in it when they move so.
Levels margin_along(const Levels& levels, const Grid& grid, const Vec3& way, MarginSide side, const Work& work);

}  // namespace kontur
