// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace kontur {

/// How two structures lie to each other.
enum class Relation {
    exclusive,  ///< no voxel belongs to both, and where they touch no gap stays between them
    inside,     ///< the first lies in the second: both have its voxels
    overlap,    ///< they may share voxels
};
std::string_view name(Relation relation) noexcept;

/// Two structures, counted from 0.
struct StructurePair {
    std::size_t first = 0, second = 0;
    Relation relation = Relation::exclusive;
    std::int64_t shared_voxels = 0;  ///< of the two masks fitted each alone
    bool is_given = false;           ///< by a rule; else the relation follows from the masks
};

}  // namespace kontur
