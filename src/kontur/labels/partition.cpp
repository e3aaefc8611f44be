// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/partition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/labels/filled_map.h"
#include "kontur/labels/structure_gaps.h"
#include "kontur/labels/union_contours.h"

namespace kontur {
namespace {

using FitUnion = std::function<FittedObject(std::span<const std::size_t>, const ContourSet&)>;

constexpr double kInside = 0.8, kOverlap = 0.25;  // shares of the smaller structure

std::int64_t voxels_of(const Mask& mask) { return std::accumulate(mask.values.begin(), mask.values.end(), std::int64_t{0}); }

/// Half of the way between neighbouring parallel planes, or half of a voxel.
double reach_mm(const ContourSet& contours, const Grid& grid) {
    const Plane& first = contours.contours.front().plane;
    std::vector<double> heights;
    for (const Contour& contour : contours.contours)
        if (std::abs(dot(contour.plane.normal, first.normal)) > 0.99)
            heights.push_back(first.distance_to(contour.points.front()));
    std::sort(heights.begin(), heights.end());
    double apart = largest(grid.spacing_mm());
    for (std::size_t n = 1; n < heights.size(); ++n) apart = std::max(apart, heights[n] - heights[n - 1]);
    return apart / 2;
}

class Structures {
public:
    Structures(SingleFits fits, const Grid& grid, std::span<const StructurePair> rules, const FitUnion& fit_union,
               const Work& work)
        : drawn_(std::move(fits.drawn)),
          functions_(std::move(fits.functions)),
          masks_(std::move(fits.masks)),
          grid_(grid),
          rules_(rules),
          fit_union_(fit_union),
          work_(work) {
        for (const BoxedMask& mask : masks_) alone_voxels_.push_back(voxels_of(mask.mask));
    }

    Partition run() {
        give_inner_to_outer();
        find_pairs();
        for (const auto& group : groups()) close_gaps(group);
        result_.masks = std::move(masks_);
        return std::move(result_);
    }

private:
    const StructurePair* rule(std::size_t a, std::size_t b) const {
        const auto is_about = [&](const StructurePair& rule) {
            return std::minmax(rule.first, rule.second) == std::minmax(a, b);
        };
        const auto found = std::find_if(rules_.begin(), rules_.end(), is_about);
        return found == rules_.end() ? nullptr : &*found;
    }

    void give_inner_to_outer() {
        for (const StructurePair& rule : rules_) {
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
        if (const StructurePair* known = rule(a, b)) return {known->first, known->second, known->relation, voxels, true};
        const std::int64_t in_a = alone_voxels_[a], in_b = alone_voxels_[b];
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
                result_.touch.push_back(touch);
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
        const auto depths = [&](std::size_t structure) { return depths_mm(functions_[structure], places, work_); };
        const std::vector<double> first = depths(pair.first), second = depths(pair.second);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            masks_[second[n] > first[n] ? pair.first : pair.second].set(voxels[n], false);
        result_.contested_voxels += static_cast<std::int64_t>(voxels.size());
    }

    /// Structures that exclude each other and touch, directly or through others.
    std::vector<std::vector<std::size_t>> groups() const {
        std::vector<std::size_t> group(drawn_.size());
        std::iota(group.begin(), group.end(), std::size_t{0});
        for (std::size_t n = 0; n < result_.touch.size(); ++n) {
            const StructurePair& pair = result_.pairs[n];
            if (!result_.touch[n] || pair.relation != Relation::exclusive) continue;
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

    void close_gaps(const std::vector<std::size_t>& group) {
        std::vector<const ContourSet*> sets;
        for (const std::size_t n : group) {
            sets.push_back(drawn_[n]);
            for (const Contour& contour : drawn_[n]->contours)
                if (!contour.closed) return;
        }
        const double least = smallest(grid_.spacing_mm());
        const ContourSet outline =
            union_contours(sets, {.step_mm = least / 2, .spacing_mm = point_spacing_mm(sets), .close_mm = least});
        if (outline.contours.empty()) return;
        double widest = 0;
        for (const ContourSet* set : sets) widest = std::max(widest, reach_mm(*set, grid_));
        if (reach_mm(outline, grid_) > widest + 1e-6) return;  // drawn in turns: each is better known than the union
        const FittedObject all = fit_union_(group, outline);
        std::vector<Index3> gaps = shared_voxels(all.mask, all.mask);
        std::erase_if(gaps, [&](const Index3& at) {
            return std::any_of(group.begin(), group.end(), [&](std::size_t s) { return masks_[s].contains(at); });
        });
        const std::vector<Vec3> places = centers_mm(gaps);
        give_gaps(group, reach_mm(outline, grid_), gaps, {places, depths_mm(all.function, places, work_)});
    }

    void give_gaps(const std::vector<std::size_t>& group, double reach_mm, const std::vector<Index3>& gaps,
                   const GapPlaces& places) {
        TouchingStructures structures{{}, reach_mm};
        const Vec3 spacing = grid_.spacing_mm();
        Index3 margin;  // farther from all of its voxels a structure is not within reach, and its f costs the most
        for (int axis = 0; axis < 3; ++axis)
            margin[axis] = static_cast<std::int64_t>(std::ceil(2 * structures.reach_mm / spacing[axis]));
        std::vector<IndexBox> within;
        for (const std::size_t n : group) {
            structures.each.push_back(functions_[n]);
            within.push_back(masks_[n].box.padded(margin, grid_.size));
        }
        const auto may_own = [&](std::size_t gap, std::size_t member) {
            if (!within[member].contains(gaps[gap])) return false;
            for (std::size_t other = 0; other < masks_.size(); ++other)
                if (masks_[other].contains(gaps[gap]) && exclude(group[member], other)) return false;
            return true;
        };
        const auto owners = owners_of_gaps(structures, places, may_own, work_);
        std::vector<std::vector<Index3>> voxels_of_member(group.size());
        for (std::size_t n = 0; n < gaps.size(); ++n)
            if (owners[n]) voxels_of_member[*owners[n]].push_back(gaps[n]), ++result_.closed_voxels;
        for (std::size_t member = 0; member < group.size(); ++member) give(group[member], voxels_of_member[member]);
    }

    bool exclude(std::size_t a, std::size_t b) const {
        for (const StructurePair& pair : result_.pairs)
            if (std::minmax(pair.first, pair.second) == std::minmax(a, b)) return pair.relation == Relation::exclusive;
        return true;
    }

    std::vector<const ContourSet*> drawn_;
    std::vector<ImplicitFunction> functions_;
    std::vector<BoxedMask> masks_;
    const Grid& grid_;
    std::span<const StructurePair> rules_;
    const FitUnion& fit_union_;
    const Work& work_;
    std::vector<std::int64_t> alone_voxels_;
    Partition result_;
};

}  // namespace

void check_rules(std::span<const StructurePair> rules, std::size_t structures) {
    const auto refuse = [](const std::string& sentence) { throw Error(ErrorKind::invalid_input, sentence); };
    std::map<std::pair<std::size_t, std::size_t>, int> counts;
    for (const StructurePair& rule : rules) {
        if (rule.first >= structures || rule.second >= structures || rule.first == rule.second)
            refuse(fmt::format("a rule is about the structures {} and {}; there are {}, counted from 0", rule.first,
                               rule.second, structures));
        if (++counts[std::minmax(rule.first, rule.second)] > 1)
            refuse(fmt::format("2 rules are about the structures {} and {}; 1 is possible", rule.first, rule.second));
    }
}

Partition partition(SingleFits fits, const Grid& grid, std::span<const StructurePair> rules, const FitUnion& fit_union,
                    const Work& work) {
    check_rules(rules, fits.masks.size());
    return Structures(std::move(fits), grid, rules, fit_union, work).run();
}

}  // namespace kontur
