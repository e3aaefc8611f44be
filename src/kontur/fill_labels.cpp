// SPDX-License-Identifier: Apache-2.0
#include "kontur/fill_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/stopwatch.h"
#include "kontur/labels/label_boxes.h"
#include "kontur/labels/painted_slices.h"
#include "kontur/labels/section_contours.h"
#include "kontur/segment.h"

namespace kontur {
namespace {

/// A label as it was painted.
struct PaintedObject {
    std::int64_t label = 0;
    std::int64_t voxels = 0;
    ContourSet contours;
    std::array<std::vector<std::int64_t>, 3> slices;  ///< indices of the painted slices, by axis
    std::array<std::vector<bool>, 3> is_whole;        ///< by axis and index, whether a slice was painted as a whole
    IndexBox range;                                   ///< where it may be filled

    /// Whether a slice says what the voxel is.
    bool is_known(const Index3& at) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (is_whole[axis][static_cast<std::size_t>(at[static_cast<int>(axis)])]) return true;
        return false;
    }
};

/// The only axis across which slices were painted; -1 when there are several.
int only_axis(const PaintedObject& object) {
    int only = -1;
    for (int axis = 0; axis < 3; ++axis) {
        if (object.slices[static_cast<std::size_t>(axis)].empty()) continue;
        if (only >= 0) return -1;
        only = axis;
    }
    return only;
}

/// The largest distance in mm of neighbouring slices; 0 for single ones.
double largest_gap_mm(const PaintedObject& object, const Grid& grid) {
    double gap = 0;
    const Vec3 spacing = grid.spacing_mm();
    for (int axis = 0; axis < 3; ++axis) {
        const auto& slices = object.slices[static_cast<std::size_t>(axis)];
        for (std::size_t n = 1; n < slices.size(); ++n)
            gap = std::max(gap, spacing[axis] * static_cast<double>(slices[n] - slices[n - 1]));
    }
    return gap;
}

/// Between parallel slices the object may be wider than on them, by less than they are apart. Slices of several directions
/// show its extent; between them it bulges.
IndexBox range_of(const PaintedObject& object, const IndexBox& box, const Grid& grid, FillEnds ends) {
    const Vec3 spacing = grid.spacing_mm();
    const int axis = only_axis(object);
    const double gap_mm = largest_gap_mm(object, grid);
    Index3 margin;
    for (int a = 0; a < 3; ++a) {
        const double bulge_mm = axis >= 0 ? gap_mm : 0.25 * spacing[a] * static_cast<double>(box.size()[a]);
        margin[a] = 3 + static_cast<std::int64_t>(std::ceil(bulge_mm / spacing[a]));
    }
    IndexBox range = box.padded(margin, grid.size);
    if (axis < 0 || ends == FillEnds::open) return range;
    const auto& slices = object.slices[static_cast<std::size_t>(axis)];
    const auto half = [&](std::int64_t gap) { return ends == FillEnds::half ? gap / 2 : 0; };
    const std::size_t last = slices.size() - 1;
    const std::int64_t first_gap = last > 0 ? slices[1] - slices[0] : 0, last_gap = last > 0 ? slices[last] - slices[last - 1] : 0;
    range.low[axis] = std::max<std::int64_t>(slices[0] - half(first_gap), 0);
    range.high[axis] = std::min<std::int64_t>(slices[last] + half(last_gap), grid.size[axis] - 1);
    return range;
}

PaintedObject look(const Image& labels, std::int64_t label, const LabelBox& found, const FillOptions& options) {
    const Grid& grid = labels.grid;
    const std::int64_t edge = 1 + static_cast<std::int64_t>(std::ceil(3 * options.smoothing_voxels));
    const IndexBox box = found.box.padded({edge, edge, edge}, grid.size);
    const Mask mask = label_mask(labels, label, box);
    PaintedObject object;
    object.label = label, object.voxels = found.voxels;
    for (int axis = 0; axis < 3; ++axis)
        object.is_whole[static_cast<std::size_t>(axis)].assign(static_cast<std::size_t>(grid.size[axis]), false);
    for (const PaintedSlice& slice : find_painted_slices(mask)) {
        const std::int64_t index = slice.index + box.low[slice.axis];
        object.slices[static_cast<std::size_t>(slice.axis)].push_back(index);
        object.is_whole[static_cast<std::size_t>(slice.axis)][static_cast<std::size_t>(index)] = slice.whole;
        std::vector<Contour> contours = section_contours(mask.grid, slice, {options.smoothing_voxels});
        std::move(contours.begin(), contours.end(), std::back_inserter(object.contours.contours));
    }
    object.range = range_of(object, found.box, grid, options.ends);
    return object;
}

/// Whether a voxel of the range is unknown.
bool is_anything_left_out(const PaintedObject& object) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto first = object.is_whole[axis].begin();
        const auto low = static_cast<std::ptrdiff_t>(object.range.low[static_cast<int>(axis)]);
        const auto high = static_cast<std::ptrdiff_t>(object.range.high[static_cast<int>(axis)]);
        if (std::all_of(first + low, first + high + 1, [](bool whole) { return whole; })) return false;
    }
    return true;
}

/// The labels on the grid while they are filled.
class FilledMap {
public:
    explicit FilledMap(Image labels) : labels_(std::move(labels)), is_painted_(static_cast<std::size_t>(labels_.grid.voxel_count())) {
        std::visit([&](const auto& samples) {
            for (std::size_t n = 0; n < samples.size(); ++n) is_painted_[n] = samples[n] != 0;
        }, labels_.samples);
    }

    const Image& labels() const { return labels_; }
    bool is_painted(std::size_t n) const { return is_painted_[n]; }
    std::int64_t label(std::size_t n) const { return static_cast<std::int64_t>(sample(labels_, n)); }
    void set_label(std::size_t n, std::int64_t label) {
        std::visit([&](auto& samples) { samples[n] = static_cast<std::decay_t<decltype(samples[n])>>(label); }, labels_.samples);
    }

    Image take() { return std::move(labels_); }

private:
    Image labels_;
    std::vector<bool> is_painted_;
};

/// How deep places lie in an object, in mm.
std::vector<double> depths(const ImplicitFunction& function, const std::vector<Vec3>& places, int threads) {
    std::vector<double> values(places.size());
    std::vector<Vec3> gradients(places.size());
    function.values_and_gradients(places, values, gradients, threads);
    constexpr double kLeastSlope = 1e-3;
    for (std::size_t n = 0; n < values.size(); ++n) values[n] /= std::max(norm(gradients[n]), kLeastSlope);
    return values;
}

class Filler {
public:
    Filler(Image labels, const FillOptions& options) : map_(std::move(labels)), options_(options) {}

    /// Fits one object and gives it what nobody painted and no deeper one has.
    void add(const PaintedObject& object, const Progress& progress) {
        SegmentOptions segmenting;
        segmenting.threads = options_.threads;
        segmenting.max_memory_mb = options_.max_memory_mb;
        const Grid& grid = map_.labels().grid;
        const Segmentation result = segment(object.contours, grid_of(grid, object.range), segmenting, progress);
        functions_.emplace(object.label, result.function);
        std::map<std::int64_t, std::vector<std::size_t>> contested;
        std::size_t place = 0;
        for (std::int64_t k = object.range.low.k; k <= object.range.high.k; ++k)
            for (std::int64_t j = object.range.low.j; j <= object.range.high.j; ++j)
                for (std::int64_t i = object.range.low.i; i <= object.range.high.i; ++i) {
                    if (!result.mask.values[place++]) continue;
                    const std::size_t n = grid.offset(i, j, k);
                    if (map_.is_painted(n) || object.is_known({i, j, k})) continue;
                    const std::int64_t other = map_.label(n);
                    if (other != 0) contested[other].push_back(n);
                    else map_.set_label(n, object.label);
                }
        for (const auto& [other, voxels] : contested) contest(object.label, other, voxels);
    }

    std::int64_t contested() const { return contested_; }
    Image take() { return map_.take(); }

private:
    Vec3 center_mm(std::size_t n) const {
        const Grid& grid = map_.labels().grid;
        const auto m = static_cast<std::int64_t>(n);
        return grid.center_mm(m % grid.size.i, m / grid.size.i % grid.size.j, m / (grid.size.i * grid.size.j));
    }

    void contest(std::int64_t label, std::int64_t other, const std::vector<std::size_t>& voxels) {
        std::vector<Vec3> places;
        for (const std::size_t n : voxels) places.push_back(center_mm(n));
        const std::vector<double> own = depths(functions_.at(label), places, options_.threads);
        const std::vector<double> others = depths(functions_.at(other), places, options_.threads);
        for (std::size_t n = 0; n < voxels.size(); ++n)
            if (own[n] > others[n]) map_.set_label(voxels[n], label);
        contested_ += static_cast<std::int64_t>(voxels.size());
    }

    FilledMap map_;
    FillOptions options_;
    std::map<std::int64_t, ImplicitFunction> functions_;
    std::int64_t contested_ = 0;
};

void check(const std::map<std::int64_t, LabelBox>& boxes, const FillOptions& options) {
    check_not_below_0("the smoothing of the painted outlines", options.smoothing_voxels, " voxels");
    check_threads(options.threads);
    if (boxes.empty()) throw Error(ErrorKind::invalid_input, "nothing is painted: all voxels of the label map are 0");
    for (const std::int64_t label : options.labels)
        if (!boxes.contains(label))
            throw Error(ErrorKind::invalid_input, fmt::format("the label {} is to be filled, but no voxel has it", label));
}

}  // namespace

std::string_view name(FillEnds ends) noexcept {
    switch (ends) {
        case FillEnds::closed:
            return "closed";
        case FillEnds::half:
            return "half";
        case FillEnds::open:
            return "open";
    }
    return "?";
}

Filling fill_labels(Image labels, const FillOptions& options, const Progress& progress) {
    FillReport report;
    Stopwatch watch(report.seconds);
    const std::map<std::int64_t, LabelBox> boxes = label_boxes(labels);
    check(boxes, options);
    std::vector<PaintedObject> objects;
    for (const auto& [label, found] : boxes) {
        progress.report("find slices", static_cast<double>(objects.size()) / static_cast<double>(boxes.size()));
        if (!options.labels.empty() && std::find(options.labels.begin(), options.labels.end(), label) == options.labels.end())
            continue;
        objects.push_back(look(labels, label, found, options));
    }
    watch.lap("find slices");

    Filler filler(std::move(labels), options);
    for (const PaintedObject& object : objects) {
        FilledLabel& filled = report.labels.emplace_back();
        filled.label = object.label, filled.painted_voxels = object.voxels;
        for (std::size_t axis = 0; axis < 3; ++axis) filled.slices[axis] = static_cast<std::int64_t>(object.slices[axis].size());
        if (!is_anything_left_out(object)) {
            filled.warnings.push_back("no slice was left out");
            continue;
        }
        try {
            filler.add(object, progress);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::invalid_input && error.kind() != ErrorKind::singular_system)
                throw error.with_context(fmt::format("label {}", object.label));
            filled.warnings.push_back(fmt::format("left as it was painted: {}", error.what()));
        }
    }
    watch.lap("fill");
    report.contested_voxels = filler.contested();
    Image full = filler.take();
    const std::map<std::int64_t, LabelBox> after = label_boxes(full);
    for (FilledLabel& filled : report.labels) filled.added_voxels = after.at(filled.label).voxels - filled.painted_voxels;
    return {std::move(full), std::move(report)};
}

}  // namespace kontur
