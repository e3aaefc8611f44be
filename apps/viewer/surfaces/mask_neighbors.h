// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/correct/ceded_voxels.h"
#include "kontur/correct/corrected_voxels.h"
#include "kontur/correct_mask.h"
#include "viewer/model/border_rules.h"
#include "viewer/model/stored_mask.h"

// Masks to be corrected that share borders: what one of them gives up goes to the one that it touched there, and what it
// takes leaves the one that had it. They follow what others drew, never what others followed.

namespace kontur::viewer {

/// What corrections of a mask mean to those beside it; by offset.
struct MaskExchange {
    std::vector<CededVoxel> ceded{};
    std::vector<std::size_t> taken{};
    std::shared_ptr<const StoredMask> kept{};  ///< of a locked mask: all of it, none of which the others get

    friend bool operator==(const MaskExchange&, const MaskExchange&) = default;
};
using MaskExchanges = std::vector<std::shared_ptr<const MaskExchange>>;

MaskExchange exchange_of(const Mask& before, const std::vector<MadeVoxel>& corrected_voxels, const Work& work = {});

/// Whether masks may share a border: they are of one grid and have no voxel in common.
bool may_share(const StoredMask& a, const StoredMask& b);
/// The same where a rule may say it.
bool may_share(const BorderRule* rule, const StoredMask& a, const StoredMask& b);
/// Whether their boxes do, which is sooner found.
bool boxes_touch(const StoredMask& a, const StoredMask& b);

/// The voxels in which a mask follows others, all of one grid; by offset. What one of them takes counts more than what
/// another one gives.
std::vector<MadeVoxel> followed_voxels(const StoredMask& own, const MaskExchanges& others);

/// Of corrections, and of what follows others: by offset, each voxel once. What was corrected counts more, and what others
/// keep counts most.
std::vector<MadeVoxel> made_and_followed(const std::vector<MadeVoxel>& corrected_voxels, const StoredMask& own,
                                         const MaskExchanges& others);

/// Those that make a locked mask what it stays; as its own corrections made them where these agree.
std::vector<MadeVoxel> made_and_kept(const std::vector<MadeVoxel>& corrected_voxels, const StoredMask& own,
                                     const StoredMask& kept);

/// The corrected mask after others, with its volume and its Dice.
CorrectedMask after_others(CorrectedMask corrected, const StoredMask& own, const MaskExchanges& others);
/// The same of a locked mask, which stays what it is.
CorrectedMask as_kept(CorrectedMask corrected, const StoredMask& own, const StoredMask& kept);

/// What corrections made of a mask, from where each of its voxels comes from.
std::vector<MadeVoxel> made_voxels(const CorrectedMask& corrected);

}  // namespace kontur::viewer
