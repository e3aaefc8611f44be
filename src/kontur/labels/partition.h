// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/labels/boxed_mask.h"
#include "kontur/labels/structure_pair.h"
#include "kontur/shape/contour.h"

namespace kontur {

/// Throws Error(invalid_input) for a rule about structures that are not among so many, or about one and itself, and for two
/// rules about one pair.
void check_rules(std::span<const StructurePair> rules, std::size_t structures);

/// Structures as they were fitted, each by itself; element n of each describes structure n.
struct SingleFits {
    std::vector<const ContourSet*> drawn;
    std::vector<ImplicitFunction> functions;
    std::vector<BoxedMask> masks;  ///< on boxes of one grid
};

/// A function and the voxels where it is positive.
struct FittedObject {
    ImplicitFunction function;
    BoxedMask mask;
};

struct Partition {
    std::vector<BoxedMask> masks;       ///< of the structures, in their order
    std::vector<StructurePair> pairs;   ///< those whose masks share voxels or faces, and those of the rules
    std::vector<bool> touch;            ///< of each pair: whether their masks shared voxels or faces
    std::int64_t contested_voxels = 0;  ///< claimed by two that exclude each other
    std::int64_t closed_voxels = 0;     ///< of gaps between them
};

/// Lets structures share their borders where they exclude each other, as `segment_together` describes it. `fit_union` fits
/// the outlines of the union of structures that touch; it is asked once for each such group of closed contours, with the
/// structures' numbers. Relations that no rule tells follow from the
/// masks. Throws as check_rules and `fit_union` do.
Partition partition(
    SingleFits fits, const Grid& grid, std::span<const StructurePair> rules,
    const std::function<FittedObject(std::span<const std::size_t> group, const ContourSet& outlines)>& fit_union,
    const Work& work = {});

}  // namespace kontur
