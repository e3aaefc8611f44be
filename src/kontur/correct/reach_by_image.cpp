// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/reach_by_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kontur/sampling/rise.h"

namespace kontur {
namespace {

constexpr std::size_t kLeastPlanes = 3, kMostLeftOut = 6;
constexpr Rise kHelps{0, 0.1};  // of the wrong voxels in left-out planes those that it mends

/// Voxels of a plane on the wrong side.
std::int64_t count_wrong(const CorrectedSection& section, const Grid& grid, const std::vector<std::uint8_t>& inside) {
    const SectionSearch right(section.after);
    std::int64_t wrong = 0;
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i) {
                const Vec3 p = grid.center_mm(i, j, k);
                if (is_in_plane(section.plane, grid, p))
                    wrong += right.contains(section.plane.to_uv(p)) != (inside[grid.offset(i, j, k)] != 0);
            }
    return wrong;
}

/// Evenly among all of them.
std::vector<std::size_t> left_out_planes(std::size_t planes) {
    std::vector<std::size_t> some;
    const std::size_t count = std::min(planes, kMostLeftOut);
    for (std::size_t n = 0; n < count; ++n) some.push_back(n * planes / count);
    return some;
}

ImageReach trust(const MaskCorrection& correction, const CarriedBox& at, const Work& work) {
    ImageReach reach;
    const std::vector<CorrectedSection>& all = correction.sections;
    if (all.size() < kLeastPlanes) return reach;
    for (const std::size_t left_out : left_out_planes(all.size())) {
        std::vector<CorrectedSection> others = all;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
        const CarriedVoxels voxels = walk_carried(correction, others, at, work);
        reach.wrong_without += count_wrong(all[left_out], at.grid, voxels.alone);
        reach.wrong_with += count_wrong(all[left_out], at.grid, voxels.followed(at.box.size(), 1));
        ++reach.planes;
    }
    if (reach.wrong_without > 0)
        reach.weight = kMostImageWeight *
                       kHelps.at(1 - static_cast<double>(reach.wrong_with) / static_cast<double>(reach.wrong_without));
    return reach;
}

}  // namespace

ImageReachedVoxels reach_by_image(const MaskCorrection& correction, const Image& image, const Work& work) {
    ImageReachedVoxels found;
    if (correction.sections.size() < kLeastPlanes) return found;
    const std::optional<CarriedBox> at = carried_box(correction, image, work);
    if (!at) return found;
    found.reach = trust(correction, *at, work);
    if (found.reach.weight <= 0.5) return found;
    const CarriedVoxels voxels = walk_carried(correction, correction.sections, *at, work);
    const std::vector<std::uint8_t> inside = voxels.followed(at->box.size(), found.reach.weight);
    const Index3 size = at->box.size();
    for (std::size_t n = 0; n < inside.size(); ++n) {
        if (inside[n] == voxels.alone[n]) continue;
        const Index3 v = index_at(n, size), &low = at->box.low;
        found.voxels.push_back({correction.mask.grid.offset(low.i + v.i, low.j + v.j, low.k + v.k), inside[n] != 0});
    }
    return found;
}

std::string sentence(const ImageReach& reach) {
    if (reach.planes == 0) return "the image takes part from three corrected planes on";
    if (reach.wrong_without == 0) return "the image had nothing to decide: planes left out come right without it";
    const double mended = 100 * (1 - static_cast<double>(reach.wrong_with) / static_cast<double>(reach.wrong_without));
    if (reach.weight <= 0.5)
        return fmt::format("the image was not followed: in planes left out, {} wrong voxels become {} with it",
                           reach.wrong_without, reach.wrong_with);
    return fmt::format(
        "the image decided how far corrections are carried: in planes left out it mends {:.0f} % of the wrong "
        "voxels",
        mended);
}

}  // namespace kontur
