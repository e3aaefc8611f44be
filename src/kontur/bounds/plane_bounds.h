// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kontur/bounds/bounds.h"
#include "kontur/bounds/drawn_regions.h"
#include "kontur/bounds/tube_ways.h"

namespace kontur {

/// What the plane of a region says of the places in it. Inside of its lines f is positive, at least a twentieth of how deep
/// the place lies: the surface may pass close above it. Outside f is negative, a quarter of how far the place is known to
/// lie outside. That is the distance to the plane's lines, to where lines of other planes cross it outside of them (it may
/// be incomplete there), and to what other planes show of the object; beyond a parallel plane that shows it, the object may
/// go on as far as to this one (end_bounds.h). Where other planes show the object on both sides, nearer than the lines are,
/// the plane shows only a part of it, and the bound fades out. Parallel planes have to be twice as near for that, and a
/// plane that shows a gap at the place does not count. Ways of
/// tubes hide themselves so, too, where the plane's own lines are far from them. The places are those of plane_lattice.h,
/// finer ones around the lines, and those of the parallel planes beside.
std::vector<Bound> plane_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, std::size_t region,
                                const std::vector<TubeWay>& ways = {});

}  // namespace kontur
