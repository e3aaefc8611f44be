// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/other_axes.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr double kOblique = 1e-3;

/// Around a box of one lattice, in steps of another.
IndexBox box_on(const IndexBox& box, const Grid& from, const Affine3& to_index) {
    Box3 around;
    for (int corner = 0; corner < 8; ++corner)
        around.extend(to_index.apply(from.center_mm(corner & 1 ? box.high.i : box.low.i, corner & 2 ? box.high.j : box.low.j,
                                                    corner & 4 ? box.high.k : box.low.k)));
    IndexBox result;
    for (int axis = 0; axis < 3; ++axis) {
        result.low[axis] = static_cast<std::int64_t>(std::floor(around.min[axis])) - 1;
        result.high[axis] = static_cast<std::int64_t>(std::ceil(around.max[axis])) + 1;
    }
    return result;
}

}  // namespace

bool is_orthogonal(const Grid& grid) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 a = normalized(grid.index_to_mm.column(axis)), b = normalized(grid.index_to_mm.column((axis + 1) % 3));
        if (std::abs(dot(a, b)) > kOblique) return false;
    }
    return true;
}

std::optional<std::array<PatientAxis, 3>> patient_axes(const Grid& grid) {
    std::array<PatientAxis, 3> found;
    std::array<bool, 3> is_used{};
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 along = normalized(grid.index_to_mm.column(axis));
        int patient = 0;
        for (int n = 1; n < 3; ++n)
            if (std::abs(along[n]) > std::abs(along[patient])) patient = n;
        for (int n = 0; n < 3; ++n)
            if (n != patient && std::abs(along[n]) > kOblique) return std::nullopt;
        if (is_used[static_cast<std::size_t>(patient)]) return std::nullopt;
        is_used[static_cast<std::size_t>(patient)] = true;
        found[static_cast<std::size_t>(patient)] = {axis, along[patient] < 0};
    }
    return found;
}

Grid patient_lattice(const Grid& grid) {
    const double step = shortest_step(grid);
    Grid lattice{grid.size, {}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 column;
        column[axis] = step;
        lattice.index_to_mm.set_column(axis, column);
    }
    lattice.index_to_mm.translation = grid.center_mm(0, 0, 0);
    return lattice;
}

Levels on_lattice(const Levels& levels, const Grid& from, const Grid& to, const Work& work) {
    if (is_empty(levels)) return {};
    const Affine3 from_index = compose(from.index_to_mm.inverse(), to.index_to_mm);
    Levels result{box_on(levels.box, from, to.index_to_mm.inverse()), {}};
    const Index3 size = result.box.size();
    result.values.resize(static_cast<std::size_t>(size.i * size.j * size.k));
    const double step_mm = shortest_step(from);
    parallel_for(size.j * size.k, 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row)
            for (std::int64_t i = 0; i < size.i; ++i) {
                const Vec3 place{static_cast<double>(result.box.low.i + i),
                                 static_cast<double>(result.box.low.j + row % size.j),
                                 static_cast<double>(result.box.low.k + row / size.j)};
                result.values[static_cast<std::size_t>(i + size.i * row)] =
                    static_cast<float>(level_at(levels, from_index.apply(place), step_mm));
            }
    });
    return trimmed(std::move(result));
}

}  // namespace kontur
