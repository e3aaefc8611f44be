// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment_together.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/labels/borrowed_borders.h"
#include "kontur/labels/boxed_mask.h"
#include "kontur/labels/partition.h"
#include "kontur/measure/components.h"

namespace kontur {
namespace {

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

class Structures {
public:
    Structures(std::span<const ContourSet> drawn, const Grid& grid, const Image* image, const TogetherOptions& options,
               const Work& work)
        : drawn_(drawn), grid_(grid), image_(image), options_(options), work_(work) {
        if (image) options_.segment.drawn_on = image->grid;
    }

    Together run() {
        result_.grid = grid_;
        for (std::size_t n = 0; n < drawn_.size(); ++n) {
            result_.structures.push_back(fit_one(n, drawn_[n]));
            masks_.push_back(take_mask(result_.structures.back()));
        }
        share_borders();
        put_masks_back();
        return std::move(result_);
    }

private:
    std::string name_of(std::size_t n) const {
        return drawn_[n].name.empty() ? fmt::format("structure {}", n + 1) : drawn_[n].name;
    }

    Segmentation fit_one(std::size_t n, const ContourSet& contours) const {
        try {
            return fit(contours, image_, options_of(n));
        } catch (const Error& error) {
            throw error.with_context(name_of(n));
        }
    }

    SegmentOptions options_of(std::size_t n) const {
        SegmentOptions options = options_.segment;
        if (n < options_.smoothing.size() && options_.smoothing[n]) options.smoothing = options_.smoothing[n];
        return options;
    }

    Segmentation fit(const ContourSet& contours, const Image* image, const SegmentOptions& options) const {
        const IndexBox box = box_of(contours, grid_);
        Segmentation result = segment(contours, grid_of(grid_, box), image, options, work_);
        if (is_cut_off(trimmed({box, result.mask}, grid_).box, box, grid_))
            return segment(contours, grid_, image, options, work_);
        return result;
    }

    /// On the smallest box.
    BoxedMask take_mask(Segmentation& structure) const {
        const IndexBox box = box_of_part(grid_, structure.mask.grid);
        return trimmed({box, std::move(structure.mask)}, grid_);
    }

    void share_borders() {
        Partition parts = parted();
        if (fit_again_to_borrowed_borders()) parts = parted();
        masks_ = std::move(parts.masks);
        result_.pairs = std::move(parts.pairs);
        result_.contested_voxels = parts.contested_voxels;
        result_.closed_voxels = parts.closed_voxels;
    }

    Partition parted() {
        SingleFits fits;
        for (const ContourSet& set : drawn_) fits.drawn.push_back(&set);
        for (const Segmentation& structure : result_.structures) fits.functions.push_back(structure.function);
        fits.masks = masks_;
        const auto fit_union = [&](std::span<const std::size_t> group, const ContourSet& outlines) {
            const auto [entry, is_new] = unions_.try_emplace({group.begin(), group.end()});
            if (is_new) {
                Segmentation all = fit(outlines, nullptr, options_.segment);
                BoxedMask mask = take_mask(all);
                entry->second = {std::move(all.function), std::move(mask)};
            }
            return entry->second;
        };
        return partition(std::move(fits), grid_, options_.rules, fit_union, work_);
    }

    /// A border that one structure alone has drawn in a plane is its neighbour's, too.
    bool fit_again_to_borrowed_borders() {
        bool is_any_new = false;
        for (const auto& [group, all] : unions_) {
            Neighbours neighbours;
            neighbours.all = &all.function;
            for (const std::size_t n : group) {
                neighbours.drawn.push_back(&drawn_[n]);
                neighbours.functions.push_back(&result_.structures[n].function);
            }
            const auto borrowed = borrowed_borders(neighbours, work_);
            for (std::size_t member = 0; member < group.size(); ++member)
                if (!borrowed[member].empty()) fit_again(group[member], borrowed[member]), is_any_new = true;
        }
        return is_any_new;
    }

    void fit_again(std::size_t n, const std::vector<SurfacePoint>& borrowed) {
        ContourSet more = drawn_[n];
        result_.borrowed_points += static_cast<std::int64_t>(borrowed.size());
        more.surface.insert(more.surface.end(), borrowed.begin(), borrowed.end());
        result_.structures[n] = fit_one(n, more);
        masks_[n] = take_mask(result_.structures[n]);
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
    TogetherOptions options_;
    const Work& work_;
    std::vector<BoxedMask> masks_;                               ///< of the single fits, then of the partition
    std::map<std::vector<std::size_t>, FittedObject> unions_{};  ///< by the structures that touch
    Together result_;
};

}  // namespace

Mask whole_mask(const Together& together, std::size_t structure) {
    const BoxedMask part{together.boxes.at(structure), together.structures.at(structure).mask};
    return widened(part, whole_box(together.grid), together.grid).mask;
}

SharedSurface shared_surface(const Together& together, const Work& work) {
    std::vector<BoxedMask> objects;
    std::vector<ImplicitFunction> functions;
    for (std::size_t n = 0; n < together.structures.size(); ++n) {
        objects.push_back({together.boxes[n], together.structures[n].mask});
        functions.push_back(together.structures[n].function);
    }
    return shared_surface(objects, functions, together.grid, work);
}

Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const TogetherOptions& options,
                          const Work& work) {
    return segment_together(drawn, grid, nullptr, options, work);
}

Together segment_together(std::span<const ContourSet> drawn, const Grid& grid, const Image* image,
                          const TogetherOptions& options, const Work& work) {
    if (drawn.empty()) throw Error(ErrorKind::invalid_input, "there are 0 structures; at least 1 is needed");
    check_rules(options.rules, drawn.size());
    check_grid(grid);
    return Structures(drawn, grid, image, options, work).run();
}

}  // namespace kontur
