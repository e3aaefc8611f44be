// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/track.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "kontur/base/parallel.h"
#include "kontur/extract/tracker.h"

namespace kontur {
namespace {

// Stands in the lattice for a value that is being computed, so that it is asked for only once.
constexpr double kPending = std::numeric_limits<double>::infinity();

/// Whether a face's four corners, given as a mask of corner bits, have both signs.
bool is_mixed(unsigned inside, unsigned face) { return (inside & face) != 0 && (inside & face) != face; }

struct Face {
    unsigned corners;  ///< as bits
    Index3 neighbour;  ///< the cell on the other side
};
constexpr Face kFaces[6] = {{0b01010101u, {-1, 0, 0}}, {0b10101010u, {1, 0, 0}},  {0b00110011u, {0, -1, 0}},
                            {0b11001100u, {0, 1, 0}},  {0b00001111u, {0, 0, -1}}, {0b11110000u, {0, 0, 1}}};

/// Layer by layer: counted first, then sorted within.
void sort_in_memory_order(std::vector<Index3>& cells, std::int64_t layers) {
    std::vector<std::size_t> starts(static_cast<std::size_t>(layers) + 2, 0);  // the lowest layer of cells is -1
    for (const Index3& c : cells) ++starts[static_cast<std::size_t>(c.k + 2)];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<Index3> sorted(cells.size());
    std::vector<std::size_t> next(starts);
    for (const Index3& c : cells) sorted[next[static_cast<std::size_t>(c.k + 1)]++] = c;
    for (std::size_t layer = 0; layer + 1 < starts.size(); ++layer)
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(starts[layer]),
                  sorted.begin() + static_cast<std::ptrdiff_t>(starts[layer + 1]),
                  [](const Index3& a, const Index3& b) { return a.j != b.j ? a.j < b.j : a.i < b.i; });
    cells = std::move(sorted);
}

constexpr Index3 kNext{1, 1, 1};

template <typename Visit>
void for_each_around(const Index3& cell, const Index3& reach, const Visit& visit) {
    for (std::int64_t k = -reach.k; k <= reach.k; ++k)
        for (std::int64_t j = -reach.j; j <= reach.j; ++j)
            for (std::int64_t i = -reach.i; i <= reach.i; ++i) visit(Index3{cell.i + i, cell.j + j, cell.k + k});
}

std::vector<Index3> cells_around(const std::vector<Index3>& centers, const Index3& reach) {
    std::vector<Index3> cells;
    for (const Index3& center : centers) for_each_around(center, reach, [&](const Index3& c) { cells.push_back(c); });
    return cells;
}

class Tracker {
public:
    Tracker(Lattice lattice, const EvaluatePoints& evaluate, const Work& work)
        : evaluate_(evaluate), work_(work), surface_{std::move(lattice), {}, 0} {}

    struct MixedCell {
        Index3 cell;
        unsigned inside;  ///< corners, as bits
    };

    /// Evaluates the cells' corners and returns the cells that the surface passes through.
    std::vector<MixedCell> keep_mixed(const std::vector<Index3>& cells) {
        std::vector<MixedCell> mixed;
        std::vector<Index3> incomplete;
        const auto keep_if_mixed = [&](const Index3& c, unsigned inside) {
            if (inside != 0 && inside != 0xffu) mixed.push_back({c, inside});
        };
        constexpr std::uint16_t kIncomplete = 256;  // most cells are known as a whole, and are looked up beside each other
        std::vector<std::uint16_t> corners(cells.size());
        parallel_for(std::ssize(cells), 4096, work_, [&](std::int64_t begin, std::int64_t end) {
            for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
                const std::array<double, 8> values = surface_.lattice.corners(cells[n]);
                const bool is_known = std::ranges::none_of(values, [](double v) { return std::isnan(v); });
                corners[n] = is_known ? static_cast<std::uint16_t>(inside_corners(values)) : kIncomplete;
            }
        });
        for (std::size_t n = 0; n < cells.size(); ++n)
            if (corners[n] == kIncomplete) incomplete.push_back(cells[n]);
            else keep_if_mixed(cells[n], corners[n]);
        if (incomplete.empty()) return mixed;
        evaluate_corners(incomplete);
        for (const Index3& c : incomplete) keep_if_mixed(c, inside_corners(surface_.lattice.corners(c)));
        return mixed;
    }

    /// Adds mixed cells to the surface and returns the cells behind their mixed faces that nobody has seen.
    std::vector<Index3> advance(const std::vector<MixedCell>& mixed) {
        std::vector<Index3> next;
        for (const auto& [c, inside] : mixed) {
            surface_.cells.push_back(c);
            for (const Face& face : kFaces) {
                if (!is_mixed(inside, face.corners)) continue;
                const Index3 n{c.i + face.neighbour.i, c.j + face.neighbour.j, c.k + face.neighbour.k};
                if (surface_.lattice.is_cell(n) && surface_.lattice.mark_cell(n)) next.push_back(n);
            }
        }
        return next;
    }

    std::vector<Index3> unseen(const std::vector<Index3>& cells) {
        std::vector<Index3> result;
        for (const Index3& c : cells)
            if (surface_.lattice.is_cell(c) && surface_.lattice.mark_cell(c)) result.push_back(c);
        return result;
    }

    /// Of the grid's cells among these, those that the surface passes neither itself nor next to.
    std::vector<Index3> unmet(const std::vector<Index3>& cells) const {
        std::vector<Index3> result;
        for (const Index3& cell : cells) {
            if (!surface_.lattice.is_cell(cell)) continue;
            bool is_met = false;
            for_each_around(cell, kNext, [&](const Index3& c) {
                const unsigned inside = surface_.lattice.is_cell(c) ? inside_corners(surface_.lattice.corners(c)) : 0;
                is_met = is_met || (inside != 0 && inside != 0xffu);
            });
            if (!is_met) result.push_back(cell);
        }
        return result;
    }

    SurfaceLattice finish() {
        sort_in_memory_order(surface_.cells, surface_.lattice.grid().size.k);
        return std::move(surface_);
    }

private:
    void evaluate_corners(const std::vector<Index3>& cells) {
        std::vector<Index3> nodes;
        for (const Index3& c : cells) {
            const std::array<double, 8> values = surface_.lattice.corners(c);
            for (int n = 0; n < 8; ++n) {
                if (!std::isnan(values[static_cast<std::size_t>(n)])) continue;
                nodes.push_back(Lattice::corner(c, n));
                surface_.lattice.set_value(nodes.back(), kPending);
            }
        }
        std::vector<Vec3> points;
        points.reserve(nodes.size());
        for (const Index3& p : nodes) points.push_back(surface_.lattice.grid().center_mm(p.i, p.j, p.k));
        std::vector<double> values(points.size());
        evaluate_(points, values);
        for (std::size_t i = 0; i < nodes.size(); ++i) surface_.lattice.set_value(nodes[i], values[i]);
        surface_.evaluations += static_cast<std::int64_t>(points.size());
    }

    const EvaluatePoints& evaluate_;
    const Work& work_;
    SurfaceLattice surface_;
};

// Between two looks at the stop token; about 10 ms on two cores.
constexpr std::size_t kKernelValuesPerBatch = 80'000'000;

void evaluate_in_batches(const ImplicitFunction& function, std::span<const Vec3> points, std::span<double> values,
                         const Work& work) {
    const std::size_t centers = std::max<std::size_t>(function.centers().size(), 1);
    const std::size_t batch = std::max<std::size_t>(kKernelValuesPerBatch / centers, 256);
    for (std::size_t begin = 0; begin < points.size(); begin += batch) {
        work.check();
        const std::size_t count = std::min(batch, points.size() - begin);
        function.values(points.subspan(begin, count), values.subspan(begin, count), work);
    }
}

/// The cells that contain the points, each once: points of a line are nearer to each other than voxels.
std::vector<Index3> cells_at(const Grid& grid, std::span<const Vec3> points) {
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    std::vector<Index3> cells;
    for (const Vec3& p : points) {
        const Vec3 at = mm_to_index.apply(p);
        if (fits_index(at)) cells.push_back(cell_of(at));
    }
    std::ranges::sort(cells, {}, [](const Index3& c) { return std::tuple(c.k, c.j, c.i); });
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());  // clang 14 cannot compile the one of std::ranges
    return cells;
}

/// How many cells are as long as the grid's largest spacing. Between two slices a thin wall at a start can pass this far to
/// the side of it on either slice; farther where it is flatter, but there it is cut between the slices.
Index3 farthest(const Grid& grid) {
    constexpr double kMostCells = 32;  // bounds the search on needles of voxels
    const Vec3 spacing = grid.spacing_mm();
    const double widest = largest(spacing);
    Index3 reach;
    for (int axis = 0; axis < 3; ++axis)
        reach[axis] = static_cast<std::int64_t>(std::min(std::round(widest / spacing[axis]), kMostCells));
    return reach;
}

}  // namespace

SurfaceLattice track_surface(Lattice lattice, const EvaluatePoints& evaluate, std::span<const Vec3> starts,
                             const Work& work) {
    const Grid grid = lattice.grid();
    Tracker tracker(std::move(lattice), evaluate, work);
    // The start's own cell can miss the surface by smoothing or rounding, so its neighbours are looked at as well; on a
    // contour they are cells that the walk visits anyway.
    const std::vector<Index3> start_cells = cells_at(grid, starts);
    auto front = tracker.keep_mixed(tracker.unseen(cells_around(start_cells, kNext)));
    if (const Index3 reach = farthest(grid); !(reach == kNext)) {
        const auto beside = tracker.keep_mixed(tracker.unseen(cells_around(tracker.unmet(start_cells), reach)));
        front.insert(front.end(), beside.begin(), beside.end());
    }
    while (!front.empty()) {
        work.check();
        front = tracker.keep_mixed(tracker.advance(front));
    }
    return tracker.finish();
}

SurfaceLattice track_surface(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts,
                             const Work& work) {
    work.report("voxelize", 0);
    return track_surface(
        Lattice(grid),
        [&](std::span<const Vec3> points, std::span<double> values) { evaluate_in_batches(function, points, values, work); },
        starts, work);
}

SurfaceLattice sample_everywhere(const ImplicitFunction& function, const Grid& grid, const Work& work) {
    SurfaceLattice surface{Lattice(grid), {}, 0};
    std::vector<Vec3> points(static_cast<std::size_t>(grid.size.i * grid.size.j));
    std::vector<double> values(points.size());
    for (std::int64_t k = 0; k < grid.size.k; ++k) {
        work.report("voxelize", static_cast<double>(k) / static_cast<double>(grid.size.k));
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                points[static_cast<std::size_t>(i + grid.size.i * j)] = grid.center_mm(i, j, k);
        evaluate_in_batches(function, points, values, work);
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                surface.lattice.set_value({i, j, k}, values[static_cast<std::size_t>(i + grid.size.i * j)]);
    }
    surface.evaluations = grid.voxel_count();
    for (std::int64_t k = -1; k < grid.size.k; ++k)
        for (std::int64_t j = -1; j < grid.size.j; ++j)
            for (std::int64_t i = -1; i < grid.size.i; ++i) {
                const unsigned inside = inside_corners(surface.lattice.corners({i, j, k}));
                if (inside != 0 && inside != 0xffu) surface.cells.push_back({i, j, k});
            }
    return surface;
}

std::vector<Vec3> cut_points(const SurfaceLattice& surface) {
    std::vector<Vec3> points;
    for (const Index3& cell : surface.cells) {  // each edge belongs to the cell of which it is among the lowest
        const double value = surface.lattice.value(cell);
        for (int axis = 0; axis < 3; ++axis) {
            const double next = surface.lattice.value(Lattice::corner(cell, 1 << axis));
            if ((value > 0) == (next > 0) || !std::isfinite(value) || !std::isfinite(next)) continue;
            Vec3 at{static_cast<double>(cell.i), static_cast<double>(cell.j), static_cast<double>(cell.k)};
            at[axis] += value / (value - next);
            points.push_back(surface.lattice.grid().index_to_mm.apply(at));
        }
    }
    return points;
}

}  // namespace kontur
