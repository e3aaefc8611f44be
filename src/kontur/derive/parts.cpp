// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kontur/measure/components.h"

namespace kontur {
namespace {

/// The points with levels > 0, or those without.
Mask side_of(const Levels& levels, bool inside) {
    Mask mask{{levels.box.size(), {}}, std::vector<std::uint8_t>(levels.values.size())};
    std::transform(levels.values.begin(), levels.values.end(), mask.values.begin(),
                   [inside](float v) { return (v > 0) == inside; });
    return mask;
}

/// Turns the components that `changes(component)` says to the other side.
template <class Changes>
Levels with_sides(Levels levels, const Components& found, const Changes& changes) {
    for (const ComponentRun& run : found.runs)
        if (changes(run.component))
            for (std::size_t n = run.begin; n < run.end; ++n) levels.values[n] = -levels.values[n];
    levels.bound = DistanceBound::none;
    return levels;
}

}  // namespace

Levels filled(Levels levels) {
    const Components outside = find_components(side_of(levels, false));
    if (outside.sizes.size() < 2) return levels;
    // The box's outermost points are outside and hang together.
    const auto first =
        std::find_if(outside.runs.begin(), outside.runs.end(), [](const auto& run) { return run.begin == 0; });
    const std::size_t around = first->component;
    return with_sides(std::move(levels), outside, [around](std::size_t component) { return component != around; });
}

Levels largest_part(Levels levels) {
    const Components inside = find_components(side_of(levels, true));
    if (inside.sizes.size() < 2) return levels;
    return trimmed(with_sides(std::move(levels), inside, [](std::size_t component) { return component != 0; }));
}

Levels parts_from(Levels levels, const Grid& grid, double least_ml) {
    const Components inside = find_components(side_of(levels, true));
    const double point_ml = grid.voxel_volume_mm3() / 1000;
    return trimmed(with_sides(std::move(levels), inside, [&](std::size_t component) {
        return static_cast<double>(inside.sizes[component]) * point_ml < least_ml;
    }));
}

}  // namespace kontur
