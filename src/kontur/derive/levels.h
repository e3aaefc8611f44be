// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/index_box.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// What is known of levels as signed distances, positive inside.
enum class DistanceBound {
    none,
    at_least,  ///< the signed distance from the surface is nowhere less
    at_most,   ///< nowhere more
};

/// A structure on the points of a lattice: inside where > 0. Beside the surface levels are like distances in mm, and between
/// two neighbours of different sides the surface lies where linear interpolation is 0.
struct Levels {
    IndexBox box{{0, 0, 0}, {0, 0, 0}};  ///< of the lattice, may reach beyond the image; outside of it nothing is inside,
                                         ///< nor on its outermost points
    std::vector<float> values{-1.0F};    ///< i fastest
    DistanceBound bound = DistanceBound::none;

    std::size_t offset(const Index3& at) const {
        const Index3 size = box.size();
        return static_cast<std::size_t>(at.i - box.low.i + size.i * (at.j - box.low.j + size.j * (at.k - box.low.k)));
    }
    /// kFarOutside beyond the box.
    float at(const Index3& place) const;
};
inline constexpr float kFarOutside = -1e6F;

/// The lattice that rules are worked out on: the image's voxel centres, and between slices that lie far apart some more.
struct WorkLattice {
    Grid grid;               ///< its axes and origin; its size is that of the image
    int thick_axis = 2;      ///< along which it is finer than the image
    std::int64_t parts = 1;  ///< by this factor
};
/// So many parts that steps are no longer than about 1.4 times those along the other axes, at most 8.
WorkLattice work_lattice(const Grid& image);

/// In steps of `grid` per step of the lattice.
Index3 steps_per_voxel(const WorkLattice& lattice);

/// Whether nothing is inside.
bool is_empty(const Levels& levels);

/// The same on the smallest box, so that a work on it costs what the object does.
Levels trimmed(Levels levels);
/// The same on another box, which contains all that is inside.
Levels on_box(const Levels& levels, const IndexBox& box, const Work& work);
/// Grown by `steps` on both sides of each axis.
IndexBox grown(const IndexBox& box, const Index3& steps);

/// max(a, b), min(a, b) and min(a, -b).
Levels join(const Levels& a, const Levels& b, const Work& work);
Levels meet(const Levels& a, const Levels& b, const Work& work);
Levels without(const Levels& a, const Levels& b, const Work& work);

/// Keeps what lies where `level` (mm, > 0 inside) says so.
Levels kept_where(Levels levels, const Grid& grid, const std::function<double(const Vec3&)>& level, const Work& work);

/// Between the lattice's points, by trilinear interpolation; `index` in steps of the lattice. Beyond the box it falls by
/// `step_mm` with each step.
double level_at(const Levels& levels, const Vec3& index, double step_mm);

/// The shortest step of a lattice, mm.
double shortest_step(const Grid& grid);

/// The voxels of the image at whose centres the levels are > 0.
Mask mask_of(const Levels& levels, const WorkLattice& lattice, const Grid& image);

/// Where the surface crosses the lattice's lines, mm.
std::vector<Vec3> surface_points(const Levels& levels, const Grid& grid);

}  // namespace kontur
