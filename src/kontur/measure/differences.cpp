// SPDX-License-Identifier: Apache-2.0
#include "kontur/measure/differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"
#include "kontur/measure/surface_voxels.h"

namespace kontur {
namespace {

/// A voxel that one mask alone has, and how far it lies from the other.
struct Surplus {
    std::size_t offset;
    double height_mm;
};

Index3 index_of(std::size_t offset, const Index3& size) {
    const auto n = static_cast<std::int64_t>(offset);
    return {n % size.i, n / size.i % size.j, n / (size.i * size.j)};
}

std::vector<Surplus> surplus_of(const Mask& a, const Mask& b, const Work& work) {
    std::vector<Surplus> surplus;
    for (std::size_t n = 0; n < a.values.size(); ++n)
        if (a.values[n] != 0 && b.values[n] == 0) surplus.push_back({n, 0});
    const PointTree other(surface_voxels(a.grid, b.values));
    parallel_for(static_cast<std::int64_t>(surplus.size()), 4096, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
            const Index3 at = index_of(surplus[n].offset, a.grid.size);
            surplus[n].height_mm = other.distance_to(a.grid.center_mm(at.i, at.j, at.k));
        }
    });
    return surplus;
}

/// Bulges, found from their tops down: each voxel joins the highest bulge beside it.
class Bulges {
public:
    /// Of these voxels, in the order of offsets.
    Bulges(const Grid& grid, const std::vector<Surplus>& voxels, double saddle) : grid_(grid), saddle_(saddle) {
        for (const Surplus& voxel : voxels) offsets_.push_back(voxel.offset);
        bulge_of_.assign(offsets_.size(), kNone);
    }

    void add(const Surplus& voxel) {
        std::optional<std::size_t> highest;
        for (const std::size_t neighbor : neighbors(voxel.offset)) {
            const std::optional<std::size_t> place = place_of(neighbor);
            if (!place || bulge_of_[*place] == kNone) continue;
            const std::size_t bulge = root(bulge_of_[*place]);
            if (!highest) highest = bulge;
            else if (bulge != *highest) highest = meet(*highest, bulge, voxel.height_mm);
        }
        if (!highest) {
            highest = tops_.size();
            tops_.push_back({voxel, 0, tops_.size()});
        }
        ++tops_[*highest].voxels;
        bulge_of_[*place_of(voxel.offset)] = *highest;
    }

    std::vector<Difference> all(bool in_first) const {
        std::vector<Difference> found;
        for (std::size_t n = 0; n < tops_.size(); ++n) {
            const Top& top = tops_[n];
            if (top.joined != n) continue;
            const Index3 at = index_of(top.voxel.offset, grid_.size);
            found.push_back({grid_.center_mm(at.i, at.j, at.k), top.voxel.height_mm,
                             static_cast<double>(top.voxels) * grid_.voxel_volume_mm3() / 1000, in_first});
        }
        return found;
    }

private:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    struct Top {
        Surplus voxel;
        std::int64_t voxels;
        std::size_t joined;  ///< the bulge that it is part of; itself
    };

    std::size_t root(std::size_t bulge) {
        while (tops_[bulge].joined != bulge) bulge = tops_[bulge].joined = tops_[tops_[bulge].joined].joined;
        return bulge;
    }

    /// Among the voxels; nothing for another one.
    std::optional<std::size_t> place_of(std::size_t offset) const {
        const auto found = std::ranges::lower_bound(offsets_, offset);
        if (found == offsets_.end() || *found != offset) return std::nullopt;
        return static_cast<std::size_t>(found - offsets_.begin());
    }

    /// Makes one of two bulges where the way between them stays high. Returns the higher one, which was begun before.
    std::size_t meet(std::size_t a, std::size_t b, double height_mm) {
        const std::size_t higher = std::min(a, b), lower = std::max(a, b);
        if (height_mm < saddle_ * tops_[lower].voxel.height_mm) return higher;
        tops_[higher].voxels += tops_[lower].voxels;
        tops_[lower].joined = higher;
        return higher;
    }

    /// Across faces, within the grid.
    std::vector<std::size_t> neighbors(std::size_t offset) const {
        const Index3& size = grid_.size;
        const Index3 at = index_of(offset, size);
        const std::array<std::size_t, 3> steps{1, static_cast<std::size_t>(size.i),
                                               static_cast<std::size_t>(size.i * size.j)};
        std::vector<std::size_t> found;
        for (int axis = 0; axis < 3; ++axis) {
            if (at[axis] > 0) found.push_back(offset - steps[static_cast<std::size_t>(axis)]);
            if (at[axis] + 1 < size[axis]) found.push_back(offset + steps[static_cast<std::size_t>(axis)]);
        }
        return found;
    }

    const Grid& grid_;
    const double saddle_;
    std::vector<std::size_t> offsets_;   ///< of the voxels, ascending
    std::vector<std::size_t> bulge_of_;  ///< of each of them
    std::vector<Top> tops_;
};

/// What the first mask has and the other has not.
std::vector<Difference> bulges_of(const Mask& a, const Mask& b, double saddle, bool in_first, const Work& work) {
    std::vector<Surplus> surplus = surplus_of(a, b, work);
    Bulges bulges(a.grid, surplus, saddle);
    std::ranges::sort(surplus, [](const Surplus& x, const Surplus& y) {
        return x.height_mm != y.height_mm ? x.height_mm > y.height_mm : x.offset < y.offset;
    });
    for (const Surplus& voxel : surplus) bulges.add(voxel);
    return bulges.all(in_first);
}

bool is_empty(const Mask& mask) {
    return std::ranges::all_of(mask.values, [](std::uint8_t value) { return value == 0; });
}

}  // namespace

std::vector<Difference> differences(const Mask& a, const Mask& b, double saddle, const Work& work) {
    check_comparable(a, b);
    if (!(saddle > 0 && saddle <= 1))
        throw Error(ErrorKind::invalid_input, fmt::format("the saddle is {}; it must be more than 0 and at most 1", saddle));
    if (is_empty(a) || is_empty(b)) return {};
    std::vector<Difference> found = bulges_of(a, b, saddle, true, work);
    work.check();
    for (const Difference& one : bulges_of({a.grid, b.values}, a, saddle, false, work)) found.push_back(one);
    std::ranges::stable_sort(found, [](const Difference& x, const Difference& y) {
        return x.distance_mm != y.distance_mm ? x.distance_mm > y.distance_mm : x.volume_ml > y.volume_ml;
    });
    return found;
}

}  // namespace kontur
