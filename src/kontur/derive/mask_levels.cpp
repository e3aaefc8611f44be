// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/mask_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/derive/crossings_distance.h"
#include "kontur/shape/inside_box.h"

namespace kontur {
namespace {

constexpr std::int64_t kAround = 2;  ///< voxels outside of the object in its box

/// Sums with the weights 1, 2, 1 along one axis of three rows of bytes.
void sum_along(const std::vector<std::uint8_t>& from, std::vector<std::uint8_t>& to, const Index3& size, int axis,
               const Work& work) {
    const std::int64_t step = axis == 0 ? 1 : axis == 1 ? size.i : size.i * size.j;
    parallel_for(size.j * size.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const std::int64_t place = axis == 1 ? row % size.j : row / size.j, last = axis == 1 ? size.j - 1 : size.k - 1;
            std::uint8_t* out = to.data() + row * size.i;
            std::fill(out, out + size.i, std::uint8_t{0});
            if (axis != 0 && (place == 0 || place == last)) continue;  // nothing is inside there, nor beside it
            const std::int64_t from_i = axis == 0 ? 1 : 0, to_i = axis == 0 ? size.i - 1 : size.i;
            const std::uint8_t* in = from.data() + row * size.i;
            for (std::int64_t i = from_i; i < to_i; ++i)
                out[i] = static_cast<std::uint8_t>(in[i - step] + 2 * in[i] + in[i + step]);
        }
    });
}

/// The level of a voxel whose smoothed value is `sum` of `whole`, in units of the smallest voxel side; a flat border between
/// two voxels gives 0.5 and -0.5.
float level_of(int sum, int whole, bool inside) {
    constexpr float kHalfWay = 0.5F;  // where smoothing would change the side
    const float level = 2 * (static_cast<float>(sum) / static_cast<float>(whole) - 0.5F);
    if (inside) return level > 0 ? level : kHalfWay;
    return level < 0 ? level : -kHalfWay;
}

/// Smoothed along all axes but one.
Levels smoothed_levels(const Mask& mask, const IndexBox& inside, int left_out_axis, const Work& work) {
    const IndexBox box = grown(inside, {kAround, kAround, kAround});
    const Index3 size = box.size();
    const std::vector<std::uint8_t> voxels = object_voxels(mask, box);
    std::vector<std::uint8_t> sums = voxels, others(voxels.size());
    int whole = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (axis == left_out_axis) continue;
        sum_along(sums, others, size, axis, work);
        std::swap(sums, others);
        whole *= 4;
    }
    const auto unit = static_cast<float>(shortest_step(mask.grid));
    std::array<std::array<float, 65>, 2> table;
    for (int sum = 0; sum <= whole; ++sum)
        for (int side = 0; side < 2; ++side)
            table[static_cast<std::size_t>(side)][static_cast<std::size_t>(sum)] = unit * level_of(sum, whole, side == 1);
    Levels levels{box, std::vector<float>(voxels.size())};
    parallel_for(static_cast<std::int64_t>(voxels.size()), 1 << 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            levels.values[n] = table[voxels[n]][sums[n]];
    });
    return levels;
}

/// Distances within each slice in place of levels, so that they can be interpolated between slices.
void measure_slices(Levels& levels, const Grid& grid, int thick_axis, const Work& work) {
    constexpr double kEverywhere = 1e5;
    CrossingsDistanceOptions options{.spacing_mm = grid.spacing_mm(), .reach = kEverywhere};
    options.left_out_axis = thick_axis;
    const std::vector<float> distances = crossings_distance(levels, options, work);
    for (std::size_t n = 0; n < distances.size(); ++n)
        levels.values[n] = levels.values[n] > 0 ? std::max(distances[n], 1e-4F) : -distances[n];
}

/// Beside an empty slice the object ends half way.
float end_beside(float level) { return -std::abs(level); }

/// Of two slices; -infinity where one is empty.
float between(float a, float b, float share) {
    if (std::isinf(a) && std::isinf(b)) return a;
    if (std::isinf(a)) a = end_beside(b);
    if (std::isinf(b)) b = end_beside(a);
    return a + share * (b - a);
}

/// Slices between slices.
Levels divided(const Levels& levels, const WorkLattice& lattice, const Work& work) {
    const int axis = lattice.thick_axis;
    const std::int64_t parts = lattice.parts;
    Levels fine{levels.box, {}};
    fine.box.low[axis] *= parts;
    fine.box.high[axis] *= parts;
    const Index3 size = fine.box.size(), coarse = levels.box.size();
    fine.values.resize(static_cast<std::size_t>(size.i * size.j * size.k));
    const std::array<std::int64_t, 3> steps{1, coarse.i, coarse.i * coarse.j};
    const std::int64_t step = steps[static_cast<std::size_t>(axis)];
    const auto empty = static_cast<float>(-shortest_step(lattice.grid) * static_cast<double>(parts));
    parallel_for(size.j * size.k, 64, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t i = 0; i < size.i; ++i) {
                Index3 at{i, row % size.j, row / size.j};
                const std::int64_t part = at[axis] % parts;
                at[axis] /= parts;
                const float* here = levels.values.data() + at.i + coarse.i * (at.j + coarse.j * at.k);
                const float share = static_cast<float>(part) / static_cast<float>(parts);
                float level = part == 0 ? *here : between(here[0], here[step], share);
                if (std::isinf(level)) level = empty;
                fine.values[static_cast<std::size_t>(i + size.i * row)] = level;
            }
    });
    return fine;
}

}  // namespace

Levels mask_levels(const Mask& mask, const WorkLattice& lattice, const Work& work) {
    check_mask(mask);
    const std::optional<IndexBox> inside = inside_box(mask);
    if (!inside) return {};
    if (lattice.parts == 1) return smoothed_levels(mask, *inside, -1, work);
    Levels levels = smoothed_levels(mask, *inside, lattice.thick_axis, work);
    measure_slices(levels, mask.grid, lattice.thick_axis, work);
    return trimmed(divided(levels, lattice, work));
}

}  // namespace kontur
