// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/mask_neighbors.h"

#include <algorithm>
#include <map>

namespace kontur::viewer {
namespace {

std::size_t count_inside(const Mask& mask) {
    return mask.values.size() - static_cast<std::size_t>(std::ranges::count(mask.values, 0));
}

/// Whether anything of it may concern the mask, by its box alone.
bool reaches(const MaskExchange& other, const StoredMask& own) {
    const auto is_near = [&](std::size_t offset) { return own.box().contains(index_at(offset, own.grid().size)); };
    return std::ranges::any_of(other.taken, is_near) || std::ranges::any_of(other.ceded, is_near, &CededVoxel::neighbor);
}

bool is_same(const MadeVoxel& a, const MadeVoxel& b) { return a.offset == b.offset && a.how == b.how; }

/// The mask of before with these voxels, and what is said of it.
CorrectedMask with_voxels(CorrectedMask corrected, const StoredMask& own, const std::vector<MadeVoxel>& voxels) {
    if (std::ranges::equal(made_voxels(corrected), voxels, is_same)) return corrected;
    const Mask before = own.mask();
    corrected.mask.values = before.values;
    corrected.origin.assign(before.values.begin(), before.values.end());
    for (const MadeVoxel& voxel : voxels) {
        corrected.mask.values[voxel.offset] = voxel.is_inside();
        corrected.origin[voxel.offset] = static_cast<std::uint8_t>(voxel.how);
    }
    const std::size_t was = count_inside(before), is = count_inside(corrected.mask);
    std::size_t both = 0;
    for (std::size_t n = 0; n < before.values.size(); ++n) both += before.values[n] != 0 && corrected.mask.values[n] != 0;
    corrected.report.dice = 2.0 * static_cast<double>(both) / static_cast<double>(was + is);
    corrected.report.volume_ml = static_cast<double>(is) * before.grid.voxel_volume_mm3() / 1000;
    return corrected;
}

}  // namespace

MaskExchange exchange_of(const Mask& before, const std::vector<MadeVoxel>& corrected_voxels, const Work& work) {
    MaskExchange exchange;
    std::vector<std::size_t> left;
    for (const MadeVoxel& voxel : corrected_voxels) (voxel.is_inside() ? exchange.taken : left).push_back(voxel.offset);
    exchange.ceded = ceded_voxels(before, left, work);
    return exchange;
}

bool may_share(const StoredMask& a, const StoredMask& b) { return a.grid() == b.grid() && !a.meets(b); }

bool may_share(const BorderRule* rule, const StoredMask& a, const StoredMask& b) {
    return rule ? rule->relation == Relation::exclusive && a.grid() == b.grid() : may_share(a, b);
}

bool boxes_touch(const StoredMask& a, const StoredMask& b) {
    if (a.grid() != b.grid()) return false;
    const IndexBox wider = a.box().padded({1, 1, 1}, a.grid().size);
    for (int axis = 0; axis < 3; ++axis)
        if (wider.low[axis] > b.box().high[axis] || wider.high[axis] < b.box().low[axis]) return false;
    return true;
}

std::vector<MadeVoxel> followed_voxels(const StoredMask& own, const MaskExchanges& others) {
    if (std::ranges::none_of(others, [&](const auto& other) { return reaches(*other, own); })) return {};
    const MaskVoxels voxels(own);
    std::map<std::size_t, CorrectedVoxel> followed;
    for (const auto& other : others)
        for (const CededVoxel& voxel : other->ceded)
            if (voxels.contains(voxel.neighbor) && !voxels.contains(voxel.offset))
                followed.emplace(voxel.offset, CorrectedVoxel::added_carried);
    for (const auto& other : others)
        for (const std::size_t offset : other->taken) {
            if (voxels.contains(offset)) followed[offset] = CorrectedVoxel::removed_carried;
            else followed.erase(offset);
        }
    std::vector<MadeVoxel> result;
    for (const auto& [offset, how] : followed) result.push_back({offset, how});
    return result;
}

std::vector<MadeVoxel> made_and_followed(const std::vector<MadeVoxel>& corrected_voxels, const StoredMask& own,
                                         const MaskExchanges& others) {
    const std::vector<MadeVoxel> followed = followed_voxels(own, others);
    std::vector<MadeVoxel> all;
    std::ranges::set_union(corrected_voxels, followed, std::back_inserter(all), {}, &MadeVoxel::offset, &MadeVoxel::offset);
    for (const auto& other : others)
        if (other->kept) {
            const MaskVoxels kept(*other->kept);
            std::erase_if(all, [&](const MadeVoxel& one) { return one.is_inside() && kept.contains(one.offset); });
        }
    return all;
}

std::vector<MadeVoxel> made_and_kept(const std::vector<MadeVoxel>& corrected_voxels, const StoredMask& own,
                                     const StoredMask& kept) {
    std::vector<MadeVoxel> all;
    const MaskVoxels before(own), after(kept);
    const IndexBox box = box_around(own.box(), kept.box());
    auto corrected = corrected_voxels.begin();
    for (std::int64_t k = box.low.k; k <= box.high.k; ++k)
        for (std::int64_t j = box.low.j; j <= box.high.j; ++j)
            for (std::int64_t i = box.low.i; i <= box.high.i; ++i) {
                const std::size_t offset = own.grid().offset(i, j, k);
                const bool is_inside = after.contains(offset);
                if (is_inside == before.contains(offset)) continue;
                while (corrected != corrected_voxels.end() && corrected->offset < offset) ++corrected;
                const bool is_own = corrected != corrected_voxels.end() && corrected->offset == offset;
                all.push_back(
                    is_own ? *corrected
                           : MadeVoxel{offset, is_inside ? CorrectedVoxel::added_carried : CorrectedVoxel::removed_carried});
            }
    return all;
}

std::vector<MadeVoxel> made_voxels(const CorrectedMask& corrected) {
    std::vector<MadeVoxel> changed;
    for (std::size_t n = 0; n < corrected.origin.size(); ++n)
        if (const auto how = static_cast<CorrectedVoxel>(corrected.origin[n]);
            how != CorrectedVoxel::outside && how != CorrectedVoxel::inside)
            changed.push_back({n, how});
    return changed;
}

CorrectedMask after_others(CorrectedMask corrected, const StoredMask& own, const MaskExchanges& others) {
    std::vector<MadeVoxel> made = made_and_followed(made_voxels(corrected), own, others);
    return with_voxels(std::move(corrected), own, made);
}

CorrectedMask as_kept(CorrectedMask corrected, const StoredMask& own, const StoredMask& kept) {
    std::vector<MadeVoxel> made = made_and_kept(made_voxels(corrected), own, kept);
    return with_voxels(std::move(corrected), own, made);
}

}  // namespace kontur::viewer
