// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to measure/: where planes contradict each other, and the wrong regions of a plane.

#include <span>
#include <vector>

#include "kontur/measure/plane_look.h"

namespace kontur {

/// Part of a plane's common line with another one, on which one of them shows the object and the other does not; or a single
/// point that contradicts the plane.
struct Contradiction {
    std::vector<Vec3> places;  ///< some of it, mm
    double length_mm = 0;
};

/// For each plane, those in it.
std::vector<std::vector<Contradiction>> contradictions(std::span<const PlaneLook> looks, const ContourSet& set);

/// What the other planes of a drawing say of a place in one of them.
class OtherPlanes {
public:
    OtherPlanes(std::span<const PlaneLook> looks, double tolerance_mm);

    /// The plane is empty there, far from its lines, and others show the object near the place: it says nothing. Slices of
    /// its own stack do not silence it.
    bool silence(const PlaneLook& own, const Vec3& place) const;
    /// Another plane, which is nearly the same one there, shows the contrary.
    bool deny(const PlaneLook& own, const Vec3& place, bool filled) const;

private:
    std::span<const PlaneLook> looks_;
    double tolerance_mm_;
    bool are_parallel_ = true;
};

/// The wrong regions of a looked-at plane, largest first.
std::vector<WrongRegion> wrong_regions(const PlaneLook& look, const std::vector<Contradiction>& contradictions,
                                       const OtherPlanes& others, double tolerance_mm);

}  // namespace kontur
