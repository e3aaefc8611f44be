// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/labels/boxed_mask.h"
#include "kontur/labels/filled_map.h"
#include "kontur/labels/gaps.h"
#include "kontur/labels/union_contours.h"
#include "kontur/measure/components.h"

namespace kontur {
namespace {

constexpr double kInside = 0.8, kOverlap = 0.25;  // shares of the smaller structure

IndexBox whole_box(const Grid& grid) { return {{0, 0, 0}, {grid.size.i - 1, grid.size.j - 1, grid.size.k - 1}}; }

/// Where the surface of what was drawn is looked for first: a quarter of its diameter around it.
IndexBox box_of(const ContourSet& contours, const Grid& grid) {
    constexpr double kMargin = 0.25;
    constexpr std::int64_t kLeastVoxels = 3;
    Box3 box = bounding_box(contours);
    for (const Vec3& p : contours.interior) box.extend(p);
    const auto found = index_box(grid, box.padded(kMargin * diameter_mm(contours)));
    if (!found) return whole_box(grid);  // `segment` says what is wrong
    return found->padded({kLeastVoxels, kLeastVoxels, kLeastVoxels}, grid.size);
}

/// Whether an object ends at a face of the box that it was looked for in, and the grid goes on.
bool is_cut_off(const IndexBox& object, const IndexBox& box, const Grid& grid) {
    for (int axis = 0; axis < 3; ++axis)
        if ((object.low[axis] == box.low[axis] && box.low[axis] > 0) ||
            (object.high[axis] == box.high[axis] && box.high[axis] + 1 < grid.size[axis]))
            return true;
    return false;
}

/// Half of the way between neighbouring parallel planes, or half of a voxel.
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
    Structures(std::span<const ContourSet> drawn, const Grid& grid, const Image* image, const TogetherOptions& options)
        : drawn_(drawn), grid_(grid), image_(image), options_(options) {}

    Together run(const Progress& progress) {
        result_.grid = grid_;
        for (std::size_t n = 0; n < drawn_.size(); ++n) {
            try {
                result_.structures.push_back(fit(drawn_[n], image_, progress));
            } catch (const Error& error) {
                throw error.with_context(name_of(n));
            }
            masks_.push_back(take_mask(result_.structures.back()));
        }
        give_inner_to_outer();
        find_pairs();
        for (const auto& group : groups()) close_gaps(group, progress);
        put_masks_back();
        return std::move(result_);
    }

private:
    std::string name_of(std::size_t n) const {
        return drawn_[n].name.empty() ? fmt::format("structure {}", n + 1) : drawn_[n].name;
    }

    Segmentation fit(const ContourSet& contours, const Image* image, const Progress& progress) const {
        const IndexBox box = box_of(contours, grid_);
        Segmentation result = segment(contours, grid_of(grid_, box), image, options_.segment, progress);
        if (is_cut_off(trimmed({box, result.mask}, grid_).box, box, grid_))
            return segment(contours, grid_, image, options_.segment, progress);
        return result;
    }

    /// On the smallest box.
    BoxedMask take_mask(Segmentation& made) const {
        const IndexBox box = box_of_part(grid_, made.mask.grid);
        return trimmed({box, std::move(made.mask)}, grid_);
    }

    const StructurePair* rule(std::size_t a, std::size_t b) const {
        const auto is_about = [&](const StructurePair& rule) {
            return std::minmax(rule.first, rule.second) == std::minmax(a, b);
        };
        const auto found = std::find_if(options_.rules.begin(), options_.rules.end(), is_about);
        return found == options_.rules.end() ? nullptr : &*found;
    }

    void give_inner_to_outer() {
        for (const StructurePair& rule : options_.rules) {
            if (rule.relation != Relation::inside) continue;
            const BoxedMask& inner = masks_[rule.first];
            give(rule.second, shared_voxels(inner, inner));
        }
    }

    void give(std::size_t structure, const std::vector<Index3>& voxels) {
        BoxedMask& mask = masks_[structure];
        IndexBox box = mask.box;
        for (const Index3& at : voxels) box = box_around(box, {at, at});
        if (box.size() != mask.box.size()) mask = widened(mask, box, grid_);
        for (const Index3& at : voxels) mask.set(at, true);
    }

    StructurePair pair_of(std::size_t a, std::size_t b, std::size_t both) const {
        const auto voxels = static_cast<std::int64_t>(both);
        if (const StructurePair* given = rule(a, b)) return {given->first, given->second, given->relation, voxels, true};
        const std::int64_t in_a = result_.structures[a].report.mask_voxels, in_b = result_.structures[b].report.mask_voxels;
        const double share =
            static_cast<double>(both) / static_cast<double>(std::max<std::int64_t>(std::min(in_a, in_b), 1));
        if (share > kInside) return {in_a <= in_b ? a : b, in_a <= in_b ? b : a, Relation::inside, voxels};
        return {a, b, share > kOverlap ? Relation::overlap : Relation::exclusive, voxels};
    }

    /// All relations are found before a voxel changes hands.
    void find_pairs() {
        std::vector<std::vector<Index3>> voxels;
        for (std::size_t a = 0; a < drawn_.size(); ++a)
            for (std::size_t b = a + 1; b < drawn_.size(); ++b) {
                std::vector<Index3> both = shared_voxels(masks_[a], masks_[b]);
                const bool touch = !both.empty() || have_common_face(masks_[a], masks_[b]);
                if (!touch && !rule(a, b)) continue;
                result_.pairs.push_back(pair_of(a, b, both.size()));
                touch_.push_back(touch);
                voxels.push_back(std::move(both));
            }
        for (std::size_t n = 0; n < voxels.size(); ++n)
            if (result_.pairs[n].relation == Relation::exclusive) contest(result_.pairs[n], voxels[n]);
    }

    std::vector<Vec3> centers_mm(const std::vector<Index3>& voxels) const {
        std::vector<Vec3> places;
        for (const Index3& at : voxels) places.push_back(grid_.center_mm(at.i, at.j, at.k));
        return places;
    }

    void contest(const StructurePair& pair, const std::vector<Index3>& voxels) {
        const std::vector<Vec3> places = centers_mm(voxels);
        const auto depths = [&](std::size_t structure) {
            return depths_mm(result_.structures[structure].function, places, options_.segment.threads);
        };
        const std::vector<double> first = depths(pair.first), second = depths(pair.second);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            masks_[second[n] > first[n] ? pair.first : pair.second].set(voxels[n], false);
        result_.contested_voxels += static_cast<std::int64_t>(voxels.size());
    }

    /// Structures that exclude each other and touch, directly or through others.
    std::vector<std::vector<std::size_t>> groups() const {
        std::vector<std::size_t> group(drawn_.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        for (std::size_t n = 0; n < touch_.size(); ++n) {
            const StructurePair& pair = result_.pairs[n];
            if (!touch_[n] || pair.relation != Relation::exclusive) continue;
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
        const ContourSet outline =
            union_contours(sets, {.step_mm = least / 2, .spacing_mm = point_spacing_mm(sets), .close_mm = least});
        if (outline.contours.empty()) return;
        Segmentation all = fit(outline, nullptr, progress);
        const BoxedMask mask = take_mask(all);
        std::vector<Index3> gaps = shared_voxels(mask, mask);
        std::erase_if(gaps, [&](const Index3& at) {
            return std::any_of(group.begin(), group.end(), [&](std::size_t s) { return masks_[s].contains(at); });
        });
        give_gaps(group, {all.function, {}, reach_mm(outline, grid_)}, gaps);
    }

    void give_gaps(const std::vector<std::size_t>& group, TouchingStructures structures, const std::vector<Index3>& gaps) {
        for (const std::size_t n : group) structures.each.push_back(result_.structures[n].function);
        const auto may_own = [&](std::size_t gap, std::size_t member) {
            for (std::size_t other = 0; other < masks_.size(); ++other)
                if (masks_[other].contains(gaps[gap]) && exclude(group[member], other)) return false;
            return true;
        };
        const auto owners = owners_of_gaps(structures, centers_mm(gaps), may_own, options_.segment.threads);
        std::vector<std::vector<Index3>> given(group.size());
        for (std::size_t n = 0; n < gaps.size(); ++n)
            if (owners[n]) given[*owners[n]].push_back(gaps[n]), ++result_.closed_voxels;
        for (std::size_t member = 0; member < group.size(); ++member) give(group[member], given[member]);
    }

    bool exclude(std::size_t a, std::size_t b) const {
        for (const StructurePair& pair : result_.pairs)
            if (std::minmax(pair.first, pair.second) == std::minmax(a, b)) return pair.relation == Relation::exclusive;
        return true;
    }

    /// With what the reports say about them, as voxels have changed hands.
    void put_masks_back() {
        for (std::size_t n = 0; n < masks_.size(); ++n) {
            BoxedMask mask = trimmed(masks_[n], grid_);
            masks_[n] = {};
            const std::vector<std::int64_t> components = component_sizes(mask.mask);
            SegmentReport& report = result_.structures[n].report;
            report.mask_voxels = std::accumulate(components.begin(), components.end(), std::int64_t{0});
            report.mask_volume_ml = static_cast<double>(report.mask_voxels) * grid_.voxel_volume_mm3() / 1000;
            report.mask_components = static_cast<std::int64_t>(components.size());
            result_.boxes.push_back(mask.box);
            result_.structures[n].mask = std::move(mask.mask);
        }
    }

    std::span<const ContourSet> drawn_;
    const Grid& grid_;
    const Image* image_;
    const TogetherOptions& options_;
    std::vector<BoxedMask> masks_;
    std::vector<bool> touch_;  ///< of each pair, before a voxel changed hands
    Together result_;
};

void check(std::size_t structures, const TogetherOptions& options) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); };
    if (structures == 0) refuse("there are 0 structures; at least 1 is needed");
    std::map<std::pair<std::size_t, std::size_t>, int> seen;
    for (const StructurePair& rule : options.rules) {
        if (rule.first >= structures || rule.second >= structures || rule.first == rule.second)
            refuse(fmt::format("a rule is about the structures {} and {}; there are {}, counted from 0", rule.first,
                               rule.second, structures));
        if (++seen[std::minmax(rule.first, rule.second)] > 1)
            refuse(fmt::format("2 rules are about the structures {} and {}; 1 is possible", rule.first, rule.second));
    }
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

Mask whole_mask(const Together& together, std::size_t structure) {
    const BoxedMask part{together.boxes.at(structure), together.structures.at(structure).mask};
    return widened(part, whole_box(together.grid), together.grid).mask;
}

Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options,
                          const Progress& progress) {
    return segment_together(drawn, grid, nullptr, options, progress);
}

Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const Image* image,
                          const TogetherOptions& options, const Progress& progress) {
    check(drawn.size(), options);
    check_grid(grid);
    return Structures(drawn, grid, image, options).run(progress);
}

}  // namespace kontur
