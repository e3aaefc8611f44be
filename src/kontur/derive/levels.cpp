// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "kontur/base/parallel.h"
#include "kontur/shape/inside_box.h"

namespace kontur {
namespace {

constexpr double kLongestStep = 1.4;  ///< of the lattice along the thick axis, in steps of the next shorter axis
constexpr std::int64_t kMostParts = 8;

/// Calls `work_on(j, k)` for all rows of a box, on all threads.
template <class RowWork>
void for_rows(const IndexBox& box, const Work& work, const RowWork& work_on) {
    const Index3 size = box.size();
    parallel_for(size.j * size.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) work_on(box.low.j + row % size.j, box.low.k + row / size.j);
    });
}

/// combine(a, b) on a box.
template <class Combine>
Levels combined(const Levels& a, const Levels& b, const IndexBox& box, const Work& work, const Combine& combine) {
    Levels result{box, {}};
    const Index3 size = box.size();
    result.values.resize(static_cast<std::size_t>(size.i * size.j * size.k));
    for_rows(box, work, [&](std::int64_t j, std::int64_t k) {
        float* out = &result.values[result.offset({box.low.i, j, k})];
        for (std::int64_t i = box.low.i; i <= box.high.i; ++i) *out++ = combine(a.at({i, j, k}), b.at({i, j, k}));
    });
    return result;
}

std::optional<IndexBox> inside_box(const Levels& levels) {
    std::optional<IndexBox> box = inside_box(levels.box.size(), std::span(levels.values), [](float v) { return v > 0; });
    if (!box) return box;
    for (int axis = 0; axis < 3; ++axis) box->low[axis] += levels.box.low[axis], box->high[axis] += levels.box.low[axis];
    return box;
}

}  // namespace

float Levels::at(const Index3& place) const { return box.contains(place) ? values[offset(place)] : kFarOutside; }

WorkLattice work_lattice(const Grid& image) {
    const Vec3 spacing = image.spacing_mm();
    WorkLattice lattice{image};
    for (int axis = 0; axis < 3; ++axis)
        if (spacing[axis] > spacing[lattice.thick_axis]) lattice.thick_axis = axis;
    const double next = std::max(spacing[(lattice.thick_axis + 1) % 3], spacing[(lattice.thick_axis + 2) % 3]);
    const double parts = std::floor(spacing[lattice.thick_axis] / (kLongestStep * next));
    lattice.parts = std::clamp(static_cast<std::int64_t>(parts), std::int64_t{1}, kMostParts);
    lattice.grid.index_to_mm.set_column(lattice.thick_axis,
                                        image.index_to_mm.column(lattice.thick_axis) / static_cast<double>(lattice.parts));
    return lattice;
}

Index3 steps_per_voxel(const WorkLattice& lattice) {
    Index3 steps{1, 1, 1};
    steps[lattice.thick_axis] = lattice.parts;
    return steps;
}

bool is_empty(const Levels& levels) {
    return std::none_of(levels.values.begin(), levels.values.end(), [](float v) { return v > 0; });
}

Levels trimmed(Levels levels) {
    const std::optional<IndexBox> inside = inside_box(levels);
    if (!inside) return {};
    const IndexBox box = *common_box(grown(*inside, {1, 1, 1}), levels.box);
    return box.low == levels.box.low && box.high == levels.box.high ? std::move(levels)
                                                                    : on_box(levels, box, {.threads = 1});
}

Levels on_box(const Levels& levels, const IndexBox& box, const Work& work) {
    Levels result{box, {}, levels.bound};
    const Index3 size = box.size();
    result.values.assign(static_cast<std::size_t>(size.i * size.j * size.k), kFarOutside);
    const std::optional<IndexBox> common = common_box(levels.box, box);
    if (!common) return result;
    for_rows(*common, work, [&](std::int64_t j, std::int64_t k) {
        const float* from = &levels.values[levels.offset({common->low.i, j, k})];
        std::copy(from, from + common->size().i, &result.values[result.offset({common->low.i, j, k})]);
    });
    return result;
}

IndexBox grown(const IndexBox& box, const Index3& steps) {
    return {{box.low.i - steps.i, box.low.j - steps.j, box.low.k - steps.k},
            {box.high.i + steps.i, box.high.j + steps.j, box.high.k + steps.k}};
}

Levels join(const Levels& a, const Levels& b, const Work& work) {
    if (is_empty(a)) return b;
    if (is_empty(b)) return a;
    return combined(a, b, box_around(a.box, b.box), work, [](float p, float q) { return std::max(p, q); });
}

Levels meet(const Levels& a, const Levels& b, const Work& work) {
    const std::optional<IndexBox> box = common_box(a.box, b.box);
    if (!box) return {};
    return trimmed(combined(a, b, *box, work, [](float p, float q) { return std::min(p, q); }));
}

Levels without(const Levels& a, const Levels& b, const Work& work) {
    return trimmed(combined(a, b, a.box, work, [](float p, float q) { return std::min(p, -q); }));
}

Levels kept_where(Levels levels, const Grid& grid, const std::function<double(const Vec3&)>& level, const Work& work) {
    for_rows(levels.box, work, [&](std::int64_t j, std::int64_t k) {
        float* out = &levels.values[levels.offset({levels.box.low.i, j, k})];
        for (std::int64_t i = levels.box.low.i; i <= levels.box.high.i; ++i, ++out)
            *out = std::min(*out, static_cast<float>(level(grid.center_mm(i, j, k))));
    });
    levels.bound = DistanceBound::none;
    return trimmed(std::move(levels));
}

double shortest_step(const Grid& grid) {
    const Vec3 spacing = grid.spacing_mm();
    return std::min({spacing.x, spacing.y, spacing.z});
}

double level_at(const Levels& levels, const Vec3& index, double step_mm) {
    Vec3 clamped, part;
    Index3 low;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t first = levels.box.low[axis], last = std::max(levels.box.high[axis] - 1, first);
        clamped[axis] = std::clamp(index[axis], static_cast<double>(first), static_cast<double>(levels.box.high[axis]));
        low[axis] = std::clamp(static_cast<std::int64_t>(std::floor(clamped[axis])), first, last);
        part[axis] = clamped[axis] - static_cast<double>(low[axis]);
    }
    const Index3 size = levels.box.size();
    const float* at = levels.values.data() + levels.offset(low);
    const std::int64_t di = size.i > 1, dj = size.j > 1 ? size.i : 0, dk = size.k > 1 ? size.i * size.j : 0;
    const auto along_i = [&](const float* p) { return p[0] + part.x * (static_cast<double>(p[di]) - p[0]); };
    const auto along_j = [&](const float* p) { return along_i(p) + part.y * (along_i(p + dj) - along_i(p)); };
    const double level = along_j(at) + part.z * (along_j(at + dk) - along_j(at));
    return clamped == index ? level : std::min(level, 0.0) - step_mm * norm(index - clamped);
}

Mask mask_of(const Levels& levels, const WorkLattice& lattice, const Grid& image) {
    Mask mask{image, std::vector<std::uint8_t>(static_cast<std::size_t>(image.voxel_count()))};
    const Index3 steps = steps_per_voxel(lattice);
    IndexBox voxels;
    for (int axis = 0; axis < 3; ++axis) {
        voxels.low[axis] = std::max<std::int64_t>(0, (levels.box.low[axis] + steps[axis] - 1) / steps[axis]);
        voxels.high[axis] = std::min(image.size[axis] - 1, levels.box.high[axis] / steps[axis]);
        if (levels.box.high[axis] < 0) return mask;
    }
    for (std::int64_t k = voxels.low.k; k <= voxels.high.k; ++k)
        for (std::int64_t j = voxels.low.j; j <= voxels.high.j; ++j)
            for (std::int64_t i = voxels.low.i; i <= voxels.high.i; ++i)
                mask.values[image.offset(i, j, k)] =
                    levels.values[levels.offset({i * steps.i, j * steps.j, k * steps.k})] > 0;
    return mask;
}

std::vector<Vec3> surface_points(const Levels& levels, const Grid& grid) {
    std::vector<Vec3> points;
    const Index3 size = levels.box.size();
    const std::array<std::int64_t, 3> steps{1, size.i, size.i * size.j};
    for (std::int64_t k = 0; k < size.k; ++k)
        for (std::int64_t j = 0; j < size.j; ++j)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const float* here = levels.values.data() + i + size.i * (j + size.j * k);
                const Index3 place{i, j, k};
                for (int axis = 0; axis < 3; ++axis) {
                    if (place[axis] + 1 >= size[axis]) continue;
                    const float next = here[steps[static_cast<std::size_t>(axis)]];
                    if ((*here > 0) == (next > 0)) continue;
                    Vec3 index{static_cast<double>(levels.box.low.i + i), static_cast<double>(levels.box.low.j + j),
                               static_cast<double>(levels.box.low.k + k)};
                    index[axis] += static_cast<double>(*here) / (static_cast<double>(*here) - static_cast<double>(next));
                    points.push_back(grid.index_to_mm.apply(index));
                }
            }
    return points;
}

}  // namespace kontur
