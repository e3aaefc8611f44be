// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/labels/shared_surface.h"
#include "kontur/labels/structure_pair.h"
#include "kontur/segment.h"
#include "kontur/shape/index_box.h"

namespace kontur {

struct TogetherOptions {
    SegmentOptions segment;
    std::vector<StructurePair> rules{};              ///< relations that are known; all others follow from the masks
    std::vector<std::optional<double>> smoothing{};  ///< of each structure; empty, or unset for one: as in `segment`
};

/// Structures of one grid, in the order of their contours.
struct Together {
    Grid grid;
    std::vector<Segmentation> structures;  ///< each with its mask on the box around it, grid_of(grid, boxes[n])
    std::vector<IndexBox> boxes;           ///< of the grid; a single voxel where a mask is empty
    std::vector<StructurePair> pairs;      ///< those whose masks share voxels or faces, and those of the rules
    std::int64_t contested_voxels = 0;     ///< claimed by two that exclude each other
    std::int64_t closed_voxels = 0;        ///< of gaps between them
    std::int64_t borrowed_points = 0;      ///< of borders that a neighbour alone has drawn, see borrowed_borders
};

/// The mask of one of them on the whole grid. Throws std::out_of_range for one that is not there.
Mask whole_mask(const Together& together, std::size_t structure);

/// The surfaces of all of them as one mesh, whose regions count them in their order.
SharedSurface shared_surface(const Together& together, const Work& work = {});

/// Segments several structures so that those that exclude each other become a partition. Each is fitted by itself; a voxel
/// that two of them claim goes to the one that it lies deepest in, f / |grad f|. Those that touch are fitted as one object,
/// too, from the outlines of their union in the planes that show all of them as far as they reach; what that has and none of
/// them goes to the nearest, as far as the union is surer of it than the nearest is of the contrary (owners_of_gaps).
/// A border that one of them alone has drawn in a plane counts for its neighbour, too, which is fitted to it once more
/// (borrowed_borders). Functions stay those of the single fits. Where no rule is given, structures that share more than 80 %
/// of the smaller one lie inside each other, from 25 % on they may overlap, else they are exclusive. By a rule that one lies
/// inside another, the outer one gets what the inner one has. A group with open contours gets no union. With an image it is
/// asked as in `segment`, for each structure. Memory is that of the structures' boxes. Throws as `segment` does, with the
/// structure's name or number in front, and Error(invalid_input) for no structures, for a rule about structures that are not
/// there and for two rules about one pair. The same bytes for any number of threads.
Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options = {},
                          const Work& work = {});
Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const Image* image,
                          const TogetherOptions& options = {}, const Work& work = {});

}  // namespace kontur
