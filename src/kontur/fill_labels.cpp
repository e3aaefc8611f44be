// SPDX-License-Identifier: Apache-2.0
#include "kontur/fill_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/labels/fill_range.h"
#include "kontur/labels/filled_map.h"
#include "kontur/labels/outline_noise.h"
#include "kontur/labels/painted_object.h"
#include "kontur/labels/scattered.h"
#include "kontur/labels/shape_interpolation.h"
#include "kontur/labels/structure_gaps.h"
#include "kontur/object_fit.h"

namespace kontur {
namespace {

/// In gaps between slices.
double beyond(FillEnds ends) {
    if (ends == FillEnds::open) return std::numeric_limits<double>::infinity();
    return ends == FillEnds::half ? 0.5 : 0;
}

/// By which factor the image makes the variance of the fit smaller; 1 where it is not used.
double variance_left(const ImageReport& image) { return image.share_left() * image.share_left(); }

/// What one fit leaves.
struct FilledObject {
    const PaintedObject* object = nullptr;
    IndexBox range;
    ImplicitFunction function;
};

class Filler {
public:
    Filler(Image labels, const Image* image, const FillOptions& options, const Work& work)
        : map_(std::move(labels)), image_(image), options_(options), work_(work) {}

    const Grid& grid() const { return map_.labels().grid; }

    /// Fits one object and gives it what nobody painted and no deeper one has. Returns what became of the image.
    ImageReport add(const PaintedObject& object, const IndexBox& range) {
        ObjectFit result = fit_object(object, {grid(), range}, image_, fit_options(), work_);
        follow_shapes(object, range, result);
        std::map<std::int64_t, std::vector<std::size_t>> contested;
        for_inside(range, result.mask, [&](const Index3& at, std::size_t n) {
            if (map_.is_painted(n) || object.is_known(at)) return;
            const std::int64_t other = map_.label(n);
            if (other != 0) contested[other].push_back(n);
            else map_.set_label(n, object.label);
        });
        fitted_.emplace(object.label, FilledObject{&object, range, result.function});
        for (const auto& [other, voxels] : contested) contest(object.label, other, voxels);
        return result.image;
    }

    /// What the union of labels that touch holds and none of them has goes to the one that is nearest.
    void close_gaps(const std::vector<std::int64_t>& labels) {
        std::vector<const PaintedObject*> objects;
        for (const std::int64_t label : labels)
            if (const auto found = fitted_.find(label); found != fitted_.end()) objects.push_back(found->second.object);
        if (objects.size() < 2) return;
        const PaintedObject all = united(objects, grid());
        if (all.slices.size() < 2) return;
        double widest_mm = 0;
        for (const PaintedObject* object : objects) widest_mm = std::max(widest_mm, largest_gap_mm(*object));
        const double gap_mm = largest_gap_mm(all);
        if (gap_mm > widest_mm) return;  // painted in turns: each is better known than the union
        const IndexBox range = range_to_fill(all, grid(), beyond(options_.ends));
        if (!is_anything_left_out(all, range)) return;
        // Between parallel slices shapes tell the union as well as a fit of all its outlines would, in a tenth of the time.
        const bool by_shapes = options_.shape_weight > 0 && all.only_axis() >= 0 && options_.ends == FillEnds::closed;
        give_to_nearest(objects, by_shapes ? gaps_between_slices(all) : gaps_in_fit(all, range), gap_mm / 2);
    }

    std::int64_t contested() const { return contested_; }
    std::int64_t closed() const { return closed_; }
    Image take() { return map_.take(); }

private:
    ObjectFitOptions fit_options() const { return {options_.smoothing_voxels, options_.use_image, options_.max_memory_mb}; }

    /// Calls visit(index, offset), both of the image, for the voxels of a mask on a range.
    template <class Visit>
    void for_inside(const IndexBox& range, const Mask& mask, const Visit& visit) const {
        std::size_t place = 0;
        for (std::int64_t k = range.low.k; k <= range.high.k; ++k)
            for (std::int64_t j = range.low.j; j <= range.high.j; ++j)
                for (std::int64_t i = range.low.i; i <= range.high.i; ++i)
                    if (mask.values[place++]) visit(Index3{i, j, k}, grid().offset(i, j, k));
    }

    /// Where the fit and the shape-based interpolation of parallel slices differ, the weighted mean of the depths in both
    /// counts.
    void follow_shapes(const PaintedObject& object, const IndexBox& range, ObjectFit& result) const {
        const int axis = object.only_axis();
        if (axis < 0 || options_.shape_weight == 0) return;
        for (std::size_t n = 1; n < object.slices.size(); ++n) {
            const PaintedSlice &low = object.slices[n - 1], &high = object.slices[n];
            if (high.index - low.index > 1) follow_shape({object, low, high}, range, result);
        }
    }

    /// Two painted slices of an object, with others between them.
    struct SlicePair {
        const PaintedObject& object;
        const PaintedSlice &low, &high;
    };

    void follow_shape(const SlicePair& pair, const IndexBox& range, ObjectFit& result) const {
        const auto& [object, low, high] = pair;
        const ShapeInterpolation shape(object.grid, low, high);
        const auto [u, v] = slice_axes(low.axis);
        std::vector<std::size_t> differing;
        std::vector<Vec3> places;
        std::vector<ShapeInterpolation::Depth> depths;
        Index3 at;
        for (at[low.axis] = low.index + 1; at[low.axis] < high.index; ++at[low.axis])
            for (at[v] = 0; at[v] < object.grid.size[v]; ++at[v])
                for (at[u] = 0; at[u] < object.grid.size[u]; ++at[u]) {
                    const Index3 in_image{at.i + object.box.low.i, at.j + object.box.low.j, at.k + object.box.low.k};
                    const std::size_t place = result.mask.grid.offset(in_image.i - range.low.i, in_image.j - range.low.j,
                                                                      in_image.k - range.low.k);
                    const ShapeInterpolation::Depth depth = shape.depth(at);
                    if ((depth.mm > 0) == (result.mask.values[place] != 0)) continue;
                    differing.push_back(place);
                    places.push_back(grid().center_mm(in_image.i, in_image.j, in_image.k));
                    depths.push_back(depth);
                }
        const double share = options_.shape_weight * shape.trust() * variance_left(result.image);
        const std::vector<double> fit_mm = depths_mm(result.function, places, work_);
        for (std::size_t n = 0; n < differing.size(); ++n) {
            const double weight = std::lerp(share, 1.0, depths[n].belief);
            result.mask.values[differing[n]] = std::lerp(fit_mm[n], depths[n].mm, weight) > 0;
        }
    }

    std::vector<Vec3> centers_mm(const std::vector<std::size_t>& voxels) const {
        std::vector<Vec3> places;
        for (const std::size_t n : voxels) {
            const Index3 at = map_.index(n);
            places.push_back(grid().center_mm(at.i, at.j, at.k));
        }
        return places;
    }

    void contest(std::int64_t label, std::int64_t other, const std::vector<std::size_t>& voxels) {
        const std::vector<Vec3> places = centers_mm(voxels);
        const std::vector<double> own = depths_mm(fitted_.at(label).function, places, work_);
        const std::vector<double> others = depths_mm(fitted_.at(other).function, places, work_);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            if (own[n] > others[n]) map_.set_label(voxels[n], label);
        contested_ += static_cast<std::int64_t>(voxels.size());
    }

    /// Voxels of no label that lie in a union, and how deep.
    struct Gaps {
        std::vector<std::size_t> voxels;
        std::vector<double> in_union_mm;
    };

    Gaps gaps_in_fit(const PaintedObject& all, const IndexBox& range) const {
        ObjectFit result = fit_outlines(all, {grid(), range}, {}, fit_options(), work_);
        follow_shapes(all, range, result);
        Gaps gaps;
        for_inside(range, result.mask, [&](const Index3& at, std::size_t n) {
            if (map_.label(n) == 0 && !all.is_known(at)) gaps.voxels.push_back(n);
        });
        gaps.in_union_mm = depths_mm(result.function, centers_mm(gaps.voxels), work_);
        return gaps;
    }

    Gaps gaps_between_slices(const PaintedObject& all) const {
        Gaps gaps;
        const int axis = all.only_axis();
        const auto [u, v] = slice_axes(axis);
        for (std::size_t n = 1; n < all.slices.size(); ++n) {
            const PaintedSlice &low = all.slices[n - 1], &high = all.slices[n];
            if (high.index - low.index < 2) continue;
            const ShapeInterpolation shape(all.grid, low, high);
            Index3 at;
            for (at[axis] = low.index + 1; at[axis] < high.index; ++at[axis])
                for (at[v] = 0; at[v] < all.grid.size[v]; ++at[v])
                    for (at[u] = 0; at[u] < all.grid.size[u]; ++at[u]) {
                        const Index3 in_image{at.i + all.box.low.i, at.j + all.box.low.j, at.k + all.box.low.k};
                        const std::size_t voxel = grid().offset(in_image.i, in_image.j, in_image.k);
                        if (map_.label(voxel) != 0 || all.is_known(in_image)) continue;
                        const double depth_mm = shape.depth(at).mm;
                        if (depth_mm <= 0) continue;
                        gaps.voxels.push_back(voxel);
                        gaps.in_union_mm.push_back(depth_mm);
                    }
        }
        return gaps;
    }

    void give_to_nearest(const std::vector<const PaintedObject*>& objects, const Gaps& gaps, double reach_mm) {
        const std::vector<std::size_t>& voxels = gaps.voxels;
        TouchingStructures structures{{}, reach_mm};
        for (const PaintedObject* object : objects) structures.each.push_back(fitted_.at(object->label).function);
        const auto may_own = [&](std::size_t n, std::size_t structure) {
            const Index3 at = map_.index(voxels[n]);
            const PaintedObject& object = *objects[structure];
            return fitted_.at(object.label).range.contains(at) && !object.is_known(at);
        };
        const auto owners = owners_of_gaps(structures, {centers_mm(voxels), gaps.in_union_mm}, may_own, work_);
        for (std::size_t n = 0; n < voxels.size(); ++n) {
            if (!owners[n]) continue;
            map_.set_label(voxels[n], objects[*owners[n]]->label);
            ++closed_;
        }
    }

    FilledMap map_;
    const Image* image_;
    FillOptions options_;
    const Work& work_;
    std::map<std::int64_t, FilledObject> fitted_;
    std::int64_t contested_ = 0, closed_ = 0;
};

void check(const std::map<std::int64_t, LabelBox>& boxes, const FillOptions& options) {
    check_not_below_0("the smoothing of the painted outlines", options.smoothing_voxels, " voxels");
    check_from_0_to_1("the weight of the shape-based interpolation", options.shape_weight);
    if (boxes.empty()) throw Error(ErrorKind::invalid_input, "nothing is painted: all voxels of the label map are 0");
    for (const std::int64_t label : options.labels)
        if (!boxes.contains(label))
            throw Error(ErrorKind::invalid_input, fmt::format("the label {} is to be filled, but no voxel has it", label));
}

void check_image_near(const Image* image, const Grid& labels) {
    if (!image) return;
    check_image(*image);
    const Box3 a = image->grid.bounds_mm(), b = labels.bounds_mm();
    for (int axis = 0; axis < 3; ++axis)
        if (a.max[axis] < b.min[axis] || b.max[axis] < a.min[axis])
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the label map and the image lie {:.0f} mm apart; are they of one patient and in one "
                                    "frame of reference?",
                                    std::max(b.min[axis] - a.max[axis], a.min[axis] - b.max[axis])));
}

std::vector<PaintedObject> look(const Image& labels, const std::map<std::int64_t, LabelBox>& boxes,
                                const FillOptions& options, const Work& work) {
    const std::int64_t margin = 1 + static_cast<std::int64_t>(std::ceil(3 * options.smoothing_voxels));
    std::vector<PaintedObject> objects;
    for (const auto& [label, found] : boxes) {
        work.report("find slices", static_cast<double>(objects.size()) / static_cast<double>(boxes.size()));
        const auto& some = options.labels;
        if (some.empty() || std::find(some.begin(), some.end(), label) != some.end())
            objects.push_back(painted_object(labels, label, found, margin));
    }
    return objects;
}

/// Calls `task`; what cannot be fitted becomes a warning.
template <class Task>
void or_warn(std::int64_t label, std::vector<std::string>& warnings, const Task& task) {
    try {
        task();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::invalid_input && error.kind() != ErrorKind::singular_system)
            throw error.with_context(fmt::format("label {}", label));
        warnings.push_back(fmt::format("left as it was painted: {}", error.what()));
    }
}

}  // namespace

std::string_view name(FillEnds ends) noexcept {
    constexpr std::array<std::string_view, 3> kNames{"closed", "half", "open"};
    const auto n = static_cast<std::size_t>(ends);
    return n < kNames.size() ? kNames[n] : "?";
}

Filling fill_labels(Image labels, const FillOptions& options, const Work& work) {
    return fill_labels(std::move(labels), nullptr, options, work);
}

Filling fill_labels(Image labels, const Image* image, const FillOptions& options, const Work& work) {
    FillReport report;
    Stopwatch watch(report.seconds);
    const std::map<std::int64_t, LabelBox> boxes = label_boxes(labels);
    check(boxes, options);
    if (options.labels.empty()) check_no_image(labels, boxes.size());
    check_threads(work.threads);
    check_image_near(image, labels.grid);
    const std::vector<PaintedObject> objects = look(labels, boxes, options, work);
    const std::vector<std::vector<std::int64_t>> touching =
        options.jointly ? touching_labels(labels) : std::vector<std::vector<std::int64_t>>{};
    watch.lap("find slices");

    Filler filler(std::move(labels), image, options, work);
    for (const PaintedObject& object : objects) {
        FilledLabel& label_report = report.labels.emplace_back();
        label_report.label = object.label, label_report.painted_voxels = object.found.voxels;
        for (const PaintedSlice& slice : object.slices) ++label_report.slices[static_cast<std::size_t>(slice.axis)];
        const IndexBox range = range_to_fill(object, filler.grid(), beyond(options.ends));
        if (is_anything_left_out(object, range))
            or_warn(object.label, label_report.warnings, [&] { label_report.image = filler.add(object, range); });
        else label_report.warnings.push_back(why_as_it_was(object));
    }
    watch.lap("fill");
    for (const auto& set : touching) filler.close_gaps(set);
    watch.lap("close gaps");

    report.contested_voxels = filler.contested();
    report.closed_voxels = filler.closed();
    Image full = filler.take();
    const std::map<std::int64_t, LabelBox> after = label_boxes(full);
    for (FilledLabel& label_report : report.labels)
        label_report.added_voxels = after.at(label_report.label).voxels - label_report.painted_voxels;
    return {std::move(full), std::move(report)};
}

}  // namespace kontur
