// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "kontur/base/progress.h"
#include "kontur/segment.h"

namespace kontur {

/// How two structures lie to each other.
enum class Relation {
    exclusive,  ///< no voxel belongs to both, and where they touch no gap stays between them
    inside,     ///< one lies in the other: both keep what they have
    overlap,    ///< they may share voxels
};
std::string_view name(Relation relation) noexcept;

/// Two structures, counted from 0, the first before the second.
struct StructurePair {
    std::size_t first = 0, second = 0;
    Relation relation = Relation::exclusive;
    std::int64_t shared_voxels = 0;  ///< of the two masks fitted each alone
};

struct TogetherOptions {
    SegmentOptions segment;
    std::vector<StructurePair> rules{};  ///< relations that are known; all others follow from the masks
};

/// Structures of one grid, in the order of their contours.
struct Together {
    std::vector<Segmentation> structures;
    std::vector<StructurePair> pairs;   ///< those whose masks share voxels or faces
    std::int64_t contested_voxels = 0;  ///< claimed by two that exclude each other
    std::int64_t closed_voxels = 0;     ///< of gaps between them
};

/// Segments several structures so that those that exclude each other become a partition. Each is fitted by itself; a voxel
/// that two of them claim goes to the one that it lies deepest in, f / |grad f|. Those that touch are fitted as one object,
/// too, from the outlines of their union in the planes that show all of them as far as they reach; a voxel in that and in
/// none of them goes to the nearest, where two are near. Functions stay those of the single fits. Where no rule is given,
/// structures that share more than 80 % of the smaller one lie inside each other, from 25 % on they may overlap, else they
/// are exclusive. A group with open contours gets no union. Throws as `segment` does, with the structure's name or number
/// in front, and Error(invalid_input) for a rule about structures that are not there. The same bytes for any number of
/// threads.
Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options = {},
                          const Progress& progress = {});

}  // namespace kontur
