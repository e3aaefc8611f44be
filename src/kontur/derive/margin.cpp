// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/margin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kontur/base/parallel.h"
#include "kontur/derive/crossings_distance.h"
#include "kontur/derive/other_axes.h"

namespace kontur {
namespace {

constexpr double kTie = 1e-4;         ///< mm; a centre that lies as far away as this within the length counts
constexpr float kLeastDepth = 1e-3F;  ///< mm of a point inside, so that it stays so when as much is added and taken away
constexpr double kNothing = 1e-3;     ///< mm, a length that moves nothing

/// Steps of a lattice that are at least so long, and one or two more.
Index3 steps_of(const Grid& grid, double length_mm) {
    const Vec3 spacing = grid.spacing_mm();
    Index3 steps;
    for (int axis = 0; axis < 3; ++axis) steps[axis] = static_cast<std::int64_t>(std::ceil(length_mm / spacing[axis])) + 2;
    return steps;
}

/// Calls change(level, distance) for every point.
template <class Change>
void change_levels(Levels& levels, const std::vector<float>& distances, const Work& work, const Change& change) {
    parallel_for(static_cast<std::int64_t>(distances.size()), 1 << 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            levels.values[n] = change(levels.values[n], distances[n]);
    });
}

/// How far distances are needed so that levels are right on both sides of the new surface.
double reach_of(const Grid& grid, double length_mm) {
    const Vec3 spacing = grid.spacing_mm();
    return length_mm + 2 * std::max({spacing.x, spacing.y, spacing.z});
}

/// The same length everywhere, on a lattice with right angles. A closing contains what was closed and an opening lies in it,
/// which rounded distances alone do not promise: bounds of the signed distance that earlier margins left do.
Levels even_margin(const Levels& levels, const Grid& grid, double length_mm, MarginSide side, const Work& work) {
    const double reach = reach_of(grid, length_mm);
    const bool grows = side == MarginSide::outwards;
    Levels result = grows ? on_box(levels, grown(levels.box, steps_of(grid, length_mm)), work) : levels;
    const std::vector<float> distances = crossings_distance(result, {.spacing_mm = grid.spacing_mm(), .reach = reach}, work);
    const auto most = static_cast<float>(reach), by = static_cast<float>(grows ? length_mm + kTie : kTie - length_mm);
    const DistanceBound bound = levels.bound;
    change_levels(result, distances, work, [=](float level, float distance) {
        const float apart = std::min(distance, most);
        const float shifted = (level > 0 ? std::max(apart, kLeastDepth) : -apart) + by;
        if (grows && bound == DistanceBound::at_most && level > kFarOutside) return std::min(shifted, level + by);
        if (!grows && bound == DistanceBound::at_least) return std::max(shifted, level + by);
        return shifted;
    });
    result.bound = grows ? DistanceBound::at_least : DistanceBound::at_most;
    return trimmed(std::move(result));
}

/// By the direction in which the surface moves, for places along the lattice's axes.
DirectedWeights weights_of(const SideLengths& lengths, const std::array<PatientAxis, 3>& axes, MarginSide side) {
    std::array<std::array<double, 2>, 3> ways{{{lengths.right, lengths.left},
                                               {lengths.anterior, lengths.posterior},
                                               {lengths.inferior, lengths.superior}}};  // towards low and high x, y, z
    DirectedWeights weights;
    for (std::size_t patient = 0; patient < 3; ++patient) {
        auto [low, high] = ways[patient];
        // Inwards the outside grows: from the left side to the right.
        if ((side == MarginSide::inwards) != axes[patient].is_against) std::swap(low, high);
        const auto axis = static_cast<std::size_t>(axes[patient].axis);
        weights.towards_low[axis] = 1 / std::max(low, kNothing);
        weights.towards_high[axis] = 1 / std::max(high, kNothing);
    }
    return weights;
}

/// Several lengths, on a lattice along the patient's axes. Distances are in units of the lengths here.
Levels uneven_margin(const Levels& levels, const Grid& grid, const SideLengths& lengths, MarginSide side, const Work& work) {
    const bool grows = side == MarginSide::outwards;
    const double largest = lengths.largest();
    Levels result = grows ? on_box(levels, grown(levels.box, steps_of(grid, largest)), work) : levels;
    const double reach = reach_of(grid, largest) / largest;
    const std::vector<float> distances = crossings_distance(
        result, {.spacing_mm = grid.spacing_mm(), .reach = reach, .weights = weights_of(lengths, *patient_axes(grid), side)},
        work);
    const auto most = static_cast<float>(reach), scale = static_cast<float>(largest);
    const auto tie = static_cast<float>(kTie / largest);
    change_levels(result, distances, work, [=](float level, float distance) {
        const float beyond = scale * (std::min(distance, most) - 1 - tie);
        return grows ? std::max(level, -beyond) : std::min(level, beyond + 2 * scale * tie);
    });
    result.bound = DistanceBound::none;
    return trimmed(std::move(result));
}

bool needs_other_axes(const Grid& grid, const SideLengths& lengths) {
    return lengths.are_alike() ? !is_orthogonal(grid) : !patient_axes(grid).has_value();
}

}  // namespace

double SideLengths::largest() const { return std::max({left, right, anterior, posterior, superior, inferior}); }

Levels margin(const Levels& levels, const Grid& grid, const SideLengths& lengths, MarginSide side, const Work& work) {
    if (is_empty(levels) || lengths.largest() == 0) return levels;
    if (needs_other_axes(grid, lengths)) {
        const Grid straight = patient_lattice(grid);
        const Levels shifted = on_lattice(margin(on_lattice(levels, grid, straight, work), straight, lengths, side, work),
                                          straight, grid, work);
        return side == MarginSide::outwards ? join(levels, shifted, work) : meet(levels, shifted, work);
    }
    return lengths.are_alike() ? even_margin(levels, grid, lengths.left, side, work)
                               : uneven_margin(levels, grid, lengths, side, work);
}

Levels margin_along(const Levels& levels, const Grid& grid, const Vec3& way, MarginSide side, const Work& work) {
    const double length = norm(way);
    if (is_empty(levels) || length == 0) return levels;
    const bool grows = side == MarginSide::outwards;
    const double step_mm = shortest_step(grid);
    const auto stops = static_cast<std::int64_t>(std::ceil(2 * length / step_mm));
    const Vec3 way_index = grid.index_to_mm.inverse().apply_linear(way);
    IndexBox box = levels.box;
    if (grows) box = grown(box, steps_of(grid, length));
    Levels result = on_box(levels, box, work);
    const Index3 size = box.size();
    parallel_for(size.j * size.k, 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const Vec3 place{static_cast<double>(box.low.i + i), static_cast<double>(box.low.j + row % size.j),
                                 static_cast<double>(box.low.k + row / size.j)};
                float& level = result.values[static_cast<std::size_t>(i + size.i * row)];
                for (std::int64_t stop = 1; stop <= stops; ++stop) {
                    const double part = static_cast<double>(stop) / static_cast<double>(stops);
                    const auto there = static_cast<float>(
                        level_at(levels, grows ? place - part * way_index : place + part * way_index, step_mm));
                    level = grows ? std::max(level, there) : std::min(level, there);
                }
            }
    });
    result.bound = DistanceBound::none;
    return trimmed(std::move(result));
}

}  // namespace kontur
