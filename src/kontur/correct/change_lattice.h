// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/change.h"
#include "kontur/correct/existing_surface.h"
#include "kontur/shape/index_box.h"

namespace kontur {

/// g at voxels, by linear interpolation on every n-th voxel, along each axis by itself: a sixth of g's length. Counted from
/// the object's box, so that a part of the mask's grid has the same values. Where the surface is farther away than g moves
/// it, g is 0.
class ChangeLattice {
public:
    ChangeLattice(const ExistingSurface& surface, const SurfaceChange& change, const IndexBox& box, const Work& work);

    const IndexBox& box() const { return box_; }
    /// At a voxel of the box.
    double at(const Index3& voxel) const;
    /// Voxels of a row from one on, to the next nodes.
    struct Run {
        std::int64_t end;  ///< along i, behind the last one
        double most_mm;    ///< |g| is nowhere larger
    };
    Run run_from(const Index3& voxel) const;
    /// |g| is nowhere larger in a row along i of the box.
    double most_in_row_mm(std::int64_t j, std::int64_t k) const;
    /// Where |f0| is larger, f0 + g has f0's sign.
    double near_mm() const { return near_mm_; }

private:
    std::int64_t offset(const Index3& node) const { return node.i + size_.i * (node.j + size_.j * node.k); }
    Index3 voxel_of(std::int64_t node) const;

    /// Where a voxel lies between the nodes of one axis.
    struct Place {
        std::int64_t low;  ///< in nodes
        double part;       ///< of the way to the next one
    };

    IndexBox box_;
    Index3 first_, step_, size_;
    double near_mm_ = 0;
    std::array<std::vector<Place>, 3> places_;  ///< of the voxels from the first node on, along each axis
    std::vector<double> values_;
    std::vector<double> row_most_;  ///< the largest |g| of each row of nodes
};

/// g where it may count, in the grid and a little beyond; null where it is 0.
std::shared_ptr<const ChangeLattice> change_lattice(const ExistingSurface& surface, const SurfaceChange& change,
                                                    const Work& work = {});

}  // namespace kontur
