// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/shape/grid.h"

namespace kontur {

/// A place whose side of the surface is known, and what the image shows there, from 0 to 1.
struct LookExample {
    Vec3 position;  ///< mm
    float look = 0;
    bool inside = false;
};

/// How the inside and the outside look, place by place: histograms of examples, each weighted by a Gaussian of its distance,
/// at the nodes of a coarse lattice.
class LocalLooks {
public:
    /// `reach_mm`: standard deviation of the Gaussian. The lattice covers `around`, a grid of cubes, and has its axes; only
    /// at places in `asked` (mm) is anything known.
    LocalLooks(std::vector<LookExample> examples, double reach_mm, const Grid& around, std::span<const Vec3> places);

    /// The logarithm of how much likelier a look is inside than outside; 0 where it is not finite or nothing is known.
    double log_odds(const Vec3& point_mm, float look) const;

    static constexpr int kBins = 16;

private:
    using LogOdds = std::array<float, kBins>;
    /// The cell of the lattice that a place is in: its first node, and how far from there to the last.
    struct Cell {
        std::array<std::int64_t, 3> first;
        std::array<double, 3> part;
    };
    Cell cell_of(const Vec3& point_mm) const;
    std::size_t corner(const Cell& cell, int corner) const;
    Affine3 mm_to_node_;
    Index3 size_;
    std::vector<LogOdds> nodes_;
};

}  // namespace kontur
