// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/labels/filled_map.h"
#include "kontur/labels/union_contours.h"

namespace kontur {
namespace {

constexpr double kInside = 0.8, kOverlap = 0.25;  // shares of the smaller structure

/// Some voxels of a grid, by their offsets.
using Voxels = std::vector<std::size_t>;

std::vector<Vec3> centers_mm(const Grid& grid, const Voxels& voxels) {
    std::vector<Vec3> places;
    for (const std::size_t n : voxels) {
        const auto m = static_cast<std::int64_t>(n);
        places.push_back(grid.center_mm(m % grid.size.i, m / grid.size.i % grid.size.j, m / (grid.size.i * grid.size.j)));
    }
    return places;
}

std::size_t count(const Mask& mask) {
    return static_cast<std::size_t>(std::count(mask.values.begin(), mask.values.end(), 1));
}

Voxels shared(const Mask& a, const Mask& b) {
    Voxels both;
    for (std::size_t n = 0; n < a.values.size(); ++n)
        if (a.values[n] & b.values[n]) both.push_back(n);
    return both;
}

/// Whether a voxel of one mask has a face in common with one of the other.
bool touch(const Mask& a, const Mask& b) {
    const Index3& size = a.grid.size;
    const auto meet = [&](std::size_t n, std::size_t m) {
        return (a.values[n] & b.values[m]) | (b.values[n] & a.values[m]);
    };
    std::size_t n = 0;
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i, ++n)
                if ((i + 1 < size.i && meet(n, n + 1)) ||
                    (j + 1 < size.j && meet(n, n + static_cast<std::size_t>(size.i))) ||
                    (k + 1 < size.k && meet(n, n + static_cast<std::size_t>(size.i * size.j))))
                    return true;
    return false;
}

/// Where gaps are looked for: as far as half of the way between neighbouring parallel planes.
double reach_mm(const ContourSet& contours, const Grid& grid) {
    const Plane& first = contours.contours.front().plane;
    std::vector<double> heights;
    for (const Contour& contour : contours.contours)
        if (std::abs(dot(contour.plane.normal, first.normal)) > 0.99)
            heights.push_back(first.distance_to(contour.points.front()));
    std::sort(heights.begin(), heights.end());
    const Vec3 spacing = grid.spacing_mm();
    double apart = std::max({spacing.x, spacing.y, spacing.z});
    for (std::size_t n = 1; n < heights.size(); ++n) apart = std::max(apart, heights[n] - heights[n - 1]);
    return apart / 2;
}

class Structures {
public:
    Structures(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options)
        : drawn_(drawn), grid_(grid), options_(options) {}

    Together run(const Progress& progress) {
        for (std::size_t n = 0; n < drawn_.size(); ++n) {
            try {
                result_.structures.push_back(segment(drawn_[n], grid_, options_.segment, progress));
            } catch (const Error& error) {
                throw error.with_context(name_of(n));
            }
        }
        find_pairs();
        for (const auto& group : groups()) close_gaps(group, progress);
        return std::move(result_);
    }

private:
    std::string name_of(std::size_t n) const {
        return drawn_[n].name.empty() ? fmt::format("structure {}", n + 1) : drawn_[n].name;
    }
    Mask& mask(std::size_t n) { return result_.structures[n].mask; }

    Relation relation(std::size_t a, std::size_t b, std::size_t both) {
        for (const StructurePair& rule : options_.rules)
            if (std::minmax(rule.first, rule.second) == std::minmax(a, b)) return rule.relation;
        const double share = static_cast<double>(both) /
                             static_cast<double>(std::max<std::size_t>(std::min(count(mask(a)), count(mask(b))), 1));
        return share > kInside ? Relation::inside : share > kOverlap ? Relation::overlap : Relation::exclusive;
    }

    /// All relations are found before a voxel changes hands.
    void find_pairs() {
        std::vector<Voxels> voxels;
        for (std::size_t a = 0; a < drawn_.size(); ++a)
            for (std::size_t b = a + 1; b < drawn_.size(); ++b) {
                Voxels both = shared(mask(a), mask(b));
                if (both.empty() && !touch(mask(a), mask(b))) continue;
                result_.pairs.push_back({a, b, relation(a, b, both.size()), static_cast<std::int64_t>(both.size())});
                voxels.push_back(std::move(both));
            }
        for (std::size_t n = 0; n < voxels.size(); ++n)
            if (result_.pairs[n].relation == Relation::exclusive) contest(result_.pairs[n], voxels[n]);
    }

    std::vector<double> depths(std::size_t structure, const std::vector<Vec3>& places) const {
        return depths_mm(result_.structures[structure].function, places, options_.segment.threads);
    }

    void contest(const StructurePair& pair, const Voxels& voxels) {
        const std::vector<Vec3> places = centers_mm(grid_, voxels);
        const std::vector<double> first = depths(pair.first, places), second = depths(pair.second, places);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            mask(second[n] > first[n] ? pair.first : pair.second).values[voxels[n]] = 0;
        result_.contested_voxels += static_cast<std::int64_t>(voxels.size());
    }

    /// Structures that exclude each other and touch, directly or through others.
    std::vector<std::vector<std::size_t>> groups() const {
        std::vector<std::size_t> group(drawn_.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        for (const StructurePair& pair : result_.pairs) {
            if (pair.relation != Relation::exclusive) continue;
            const auto [kept, joined] = std::minmax(group[pair.first], group[pair.second]);
            std::replace(group.begin(), group.end(), std::size_t{joined}, std::size_t{kept});
        }
        std::map<std::size_t, std::vector<std::size_t>> found;
        for (std::size_t n = 0; n < group.size(); ++n) found[group[n]].push_back(n);
        std::vector<std::vector<std::size_t>> groups;
        for (auto& [first, members] : found)
            if (members.size() > 1) groups.push_back(std::move(members));
        return groups;
    }

    void close_gaps(const std::vector<std::size_t>& group, const Progress& progress) {
        std::vector<const ContourSet*> sets;
        for (const std::size_t n : group) {
            sets.push_back(&drawn_[n]);
            for (const Contour& contour : drawn_[n].contours)
                if (!contour.closed) return;
        }
        const Vec3 spacing = grid_.spacing_mm();
        const double least = std::min({spacing.x, spacing.y, spacing.z});
        const ContourSet outline = union_contours(sets, {.step_mm = least / 2, .close_mm = least});
        if (outline.contours.empty()) return;
        const Segmentation all = segment(outline, grid_, options_.segment, progress);
        Voxels gaps;
        for (std::size_t n = 0; n < all.mask.values.size(); ++n)
            if (all.mask.values[n] &&
                std::none_of(group.begin(), group.end(), [&](std::size_t s) { return mask(s).values[n]; }))
                gaps.push_back(n);
        give_to_nearest(group, gaps, reach_mm(outline, grid_));
    }

    void give_to_nearest(const std::vector<std::size_t>& group, const Voxels& voxels, double reach) {
        const std::vector<Vec3> places = centers_mm(grid_, voxels);
        constexpr double kFar = -std::numeric_limits<double>::infinity();
        std::vector<double> best(voxels.size(), kFar), next(best);
        std::vector<std::size_t> owner(voxels.size());
        for (const std::size_t structure : group) {
            const std::vector<double> own = depths(structure, places);
            for (std::size_t n = 0; n < voxels.size(); ++n) {
                if (own[n] > best[n]) next[n] = best[n], best[n] = own[n], owner[n] = structure;
                else next[n] = std::max(next[n], own[n]);
            }
        }
        for (std::size_t n = 0; n < voxels.size(); ++n) {
            if (!(next[n] > -reach)) continue;
            mask(owner[n]).values[voxels[n]] = 1;
            ++result_.closed_voxels;
        }
    }

    std::span<const ContourSet> drawn_;
    const Grid& grid_;
    const TogetherOptions& options_;
    Together result_;
};

void check(std::size_t structures, const TogetherOptions& options) {
    for (const StructurePair& rule : options.rules)
        if (rule.first >= structures || rule.second >= structures || rule.first == rule.second)
            throw Error(ErrorKind::invalid_input,
                        fmt::format("a rule is about the structures {} and {}; there are {}, counted from 0", rule.first,
                                    rule.second, structures));
}

}  // namespace

std::string_view name(Relation relation) noexcept {
    switch (relation) {
        case Relation::exclusive:
            return "exclusive";
        case Relation::inside:
            return "inside";
        case Relation::overlap:
            return "overlap";
    }
    return "?";
}

Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options,
                          const Progress& progress) {
    check(drawn.size(), options);
    return Structures(drawn, grid, options).run(progress);
}

}  // namespace kontur
