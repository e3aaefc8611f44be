// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: ways from one section of a tube to the next, along a bend.

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "kontur/measure/plane_look.h"

namespace kontur {

inline constexpr std::array kQuarters{0.25, 0.5, 0.75};  // of a way, where it is looked at

/// Ways from places of one outline to the same places of another, at their quarters.
struct BentWays {
    std::size_t own = 0, to = 0;         ///< looks
    std::size_t contour = 0, other = 0;  ///< indices
    double length_mm = 0;
    Vec3 direction;  ///< from one middle to the other
    std::vector<std::array<Vec3, kQuarters.size()>> places;
};

/// An outline as a section of a tube.
struct Ring {
    std::size_t section = 0, contour = 0;  ///< indices
    Vec3 middle, normal;
    double radius_mm = 0;  ///< of a circle of the same area
};

/// Outlines of which each is the nearest ahead of the other: within 45 degrees of both normals, of radii that differ by less
/// than two, and at least three radii apart. A section may be null: of a plane that is empty.
std::vector<std::pair<Ring, Ring>> ring_pairs(std::span<const Section* const> sections);

/// Between such outlines.
std::vector<BentWays> bent_ways(std::span<const PlaneLook> looks);

}  // namespace kontur
