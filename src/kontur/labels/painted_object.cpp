// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/painted_object.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "kontur/labels/section_contours.h"

namespace kontur {
namespace {

void mark_whole(PaintedObject& object, const Grid& image) {
    for (int axis = 0; axis < 3; ++axis)
        object.is_whole[static_cast<std::size_t>(axis)].assign(static_cast<std::size_t>(image.size[axis]), false);
    for (const PaintedSlice& slice : object.slices)
        object.is_whole[static_cast<std::size_t>(slice.axis)]
                       [static_cast<std::size_t>(slice.index + object.box.low[slice.axis])] = slice.whole;
}

/// Whether each object that reaches a slice was painted on it as a whole.
bool show_all(std::span<const PaintedObject* const> objects, int axis, std::int64_t index) {
    return std::all_of(objects.begin(), objects.end(), [&](const PaintedObject* object) {
        const bool reaches = index >= object->found.box.low[axis] && index <= object->found.box.high[axis];
        return !reaches || object->is_whole[static_cast<std::size_t>(axis)][static_cast<std::size_t>(index)];
    });
}

/// Sets the section's places in a slice of a larger box.
void add_section(const PaintedObject& object, const PaintedSlice& part, const IndexBox& box, PaintedSlice& whole) {
    const auto [u, v] = slice_axes(part.axis);
    const std::int64_t width = object.grid.size[u], wide = box.size()[u];
    for (std::size_t n = 0; n < part.section.size(); ++n) {
        if (!part.section[n]) continue;
        const std::int64_t a = static_cast<std::int64_t>(n) % width + object.box.low[u] - box.low[u];
        const std::int64_t b = static_cast<std::int64_t>(n) / width + object.box.low[v] - box.low[v];
        whole.section[static_cast<std::size_t>(a + wide * b)] = 1;
    }
}

/// Joins what belongs together.
class Sets {
public:
    std::int64_t root(std::int64_t label) {
        auto [found, is_new] = parents_.try_emplace(label, label);
        while (found->second != found->first) found = parents_.find(found->second);
        return found->first;
    }
    void join(std::int64_t a, std::int64_t b) {
        const std::int64_t root_a = root(a), root_b = root(b);
        parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }
    std::vector<std::vector<std::int64_t>> sets() {
        std::map<std::int64_t, std::vector<std::int64_t>> found;
        for (const auto& entry : parents_) found[root(entry.first)].push_back(entry.first);
        std::vector<std::vector<std::int64_t>> sets;
        for (auto& [root, members] : found) sets.push_back(std::move(members));
        return sets;
    }

private:
    std::map<std::int64_t, std::int64_t> parents_;
};

}  // namespace

bool PaintedObject::is_known(const Index3& at) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (is_whole[axis][static_cast<std::size_t>(at[static_cast<int>(axis)])]) return true;
    return false;
}

int PaintedObject::only_axis() const {
    if (slices.empty() || slices.front().axis != slices.back().axis) return -1;
    return slices.front().axis;
}

std::vector<std::int64_t> PaintedObject::indices(int axis) const {
    std::vector<std::int64_t> found;
    for (const PaintedSlice& slice : slices)
        if (slice.axis == axis) found.push_back(slice.index + box.low[axis]);
    return found;
}

PaintedObject painted_object(const Image& labels, std::int64_t label, const LabelBox& found, std::int64_t margin) {
    PaintedObject object{label, found, found.box.padded({margin, margin, margin}, labels.grid.size), {}, {}};
    const Mask mask = label_mask(labels, label, object.box);
    object.grid = mask.grid;
    object.slices = find_painted_slices(mask);
    mark_whole(object, labels.grid);
    return object;
}

PaintedObject united(std::span<const PaintedObject* const> objects, const Grid& image) {
    PaintedObject all;
    all.found = objects.front()->found, all.box = objects.front()->box;
    std::map<std::pair<int, std::int64_t>, PaintedSlice> slices;
    for (const PaintedObject* object : objects)
        for (int axis = 0; axis < 3; ++axis) {
            all.found.box.low[axis] = std::min(all.found.box.low[axis], object->found.box.low[axis]);
            all.found.box.high[axis] = std::max(all.found.box.high[axis], object->found.box.high[axis]);
            all.box.low[axis] = std::min(all.box.low[axis], object->box.low[axis]);
            all.box.high[axis] = std::max(all.box.high[axis], object->box.high[axis]);
        }
    all.grid = grid_of(image, all.box);
    for (const PaintedObject* object : objects)
        for (const PaintedSlice& part : object->slices) {
            const std::int64_t index = part.index + object->box.low[part.axis];
            if (!show_all(objects, part.axis, index)) continue;
            PaintedSlice& slice = slices[{part.axis, index}];
            const auto [u, v] = slice_axes(part.axis);
            slice.axis = part.axis, slice.index = index - all.box.low[part.axis];
            slice.section.resize(static_cast<std::size_t>(all.grid.size[u] * all.grid.size[v]));
            add_section(*object, part, all.box, slice);
        }
    for (auto& [place, slice] : slices) all.slices.push_back(std::move(slice));
    mark_whole(all, image);
    return all;
}

ContourSet contours_of(const PaintedObject& object, double smoothing_voxels) {
    ContourSet set;
    for (const PaintedSlice& slice : object.slices) {
        std::vector<Contour> contours = section_contours(object.grid, slice, {smoothing_voxels});
        std::move(contours.begin(), contours.end(), std::back_inserter(set.contours));
    }
    return set;
}

std::vector<std::vector<std::int64_t>> touching_labels(const Image& labels) {
    std::set<std::pair<std::int64_t, std::int64_t>> pairs;
    const Index3& size = labels.grid.size;
    const auto look = [&](const auto& samples) {
        for (std::int64_t k = 0; k < size.k; ++k)
            for (std::int64_t j = 0; j < size.j; ++j) {
                const auto* const row = samples.data() + labels.grid.offset(0, j, k);
                const auto* const next_row = j + 1 < size.j ? row + size.i : row;
                const auto* const next_slice = k + 1 < size.k ? row + size.i * size.j : row;
                for (std::int64_t i = 0; i < size.i; ++i) {
                    if (row[i] == 0) continue;
                    const std::int64_t beside = i + 1 < size.i ? i + 1 : i;
                    for (const auto other : {row[beside], next_row[i], next_slice[i]})
                        if (other != 0 && other != row[i])
                            pairs.emplace(static_cast<std::int64_t>(row[i]), static_cast<std::int64_t>(other));
                }
            }
    };
    std::visit(look, labels.samples);
    Sets sets;
    for (const auto& [a, b] : pairs) sets.join(a, b);
    return sets.sets();
}

}  // namespace kontur
