// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "kontur/field/constraints.h"

namespace kontur {

struct DrawnPlanes;

/// A point where f is bounded: it should not exceed `most_mm` nor fall below `least_mm`.
struct Cap {
    Vec3 position;
    double most_mm;
    double value_mm;  ///< what is prescribed if it does
    double least_mm = -std::numeric_limits<double>::infinity();
    bool from_start = false;  ///< prescribed whether or not it does
    ConstraintKind kind = ConstraintKind::cap;
    double trust = 1;  ///< of that constraint
    bool far = false;  ///< a leak probe far beyond an end: a leak there says nothing about those elsewhere

    bool allows(double f) const { return f >= least_mm && f <= most_mm; }
};

/// What bounds the extrapolation.
struct Limits {
    std::vector<Cap> caps;           ///< beyond the last contours
    std::vector<Cap> leak_probes;    ///< where a leak would show
    std::vector<std::string> notes;  ///< a word on a thickness that is but a guess, contours counted from 1
};

/// Contours say nothing about the space beyond the last of them, where a smooth interpolant runs on: a stack of equal
/// circles becomes an endless cylinder. For every drawn plane and each of its sides there are caps:
///
/// - where contours of other directions lead on beyond the plane, there is no limit: they tell where the object ends.
///   Those tilted by less than 37 degrees lead on only if they reach farther than the radius of the largest inscribed
///   circle; if they do not, there is no cap, either, but there are leak probes;
/// - towards the next parallel plane, what lies well inside here and outside of that plane's contours ends before it;
/// - beyond the last parallel plane the object ends within a rounded cap, as high as the distance to the plane before it,
///   but not higher than 1.5 radii of the largest inscribed circle. Where there is no plane before it, or none farther away
///   than 2 % of that radius, the radius is the height, and a note says so. Where single surface or interior points lie
///   farther out, it is a quarter higher than they are. Below a cap lower than a quarter of that radius, points in the
///   section are bounded from below.
///
/// At most a few hundred points per plane; spacings follow the contours' size, so the caps move, turn and scale with them.
///
/// In a drawn plane, what lies outside of all its contours is outside of the object, and so is what lies beside a cap at its
/// height or anywhere above it from twice the height on; but far from the contours the interpolant may turn positive again,
/// and such a sheet can join the object. Leak probes lie on a lattice over each of these planes, in a ball of twice the
/// diameter of the smallest one around the contours. Where contours of other planes cross a drawn plane outside of its own,
/// it may be incomplete: there the points keep twice the distance of these crossings. Where contours of other directions
/// alone say where the object ends, leak probes lie on the surface of that ball, too.
Limits find_limits(const DrawnPlanes& planes, int threads = 0);

}  // namespace kontur
