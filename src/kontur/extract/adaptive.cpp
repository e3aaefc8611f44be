// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/adaptive.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "kontur/base/parallel.h"
#include "kontur/extract/coarse_band.h"
#include "kontur/extract/cubic_cells.h"
#include "kontur/extract/tracker.h"
#include "kontur/function/fast_function.h"

namespace kontur {
namespace {

// Smaller objects have fewer corners on their surface than the coarse lattice needs nodes.
constexpr double kLeastExtentVoxels = 20;

// A value in doubt is smaller than these fractions of the coarse spacing; f is least smooth at its centres.
constexpr double kDoubtAtCentres = 0.047, kDoubtBesideCentres = 0.016, kDoubtElsewhere = 0.006;
// ... and smaller than the interpolation's errors found in the cell, or half of those in a neighbour, times this.
constexpr double kDoubtPerError = 2;
constexpr int kPasses = 4;

// Error of the fast function in voxels; values below a part of what it is found to be are computed by the direct sum.
constexpr double kFastTolerance = 0.02;
constexpr double kUnsurePerError = 0.5;  ///< the largest error of hundreds is about three standard deviations

/// The stride that brings each axis close to the same coarse spacing in mm.
Index3 strides(const Grid& grid) {
    const Vec3 spacing = grid.spacing_mm();
    const double target = kCoarseStride * std::cbrt(spacing.x * spacing.y * spacing.z);
    Index3 stride;
    for (int axis = 0; axis < 3; ++axis) stride[axis] = std::max<std::int64_t>(1, std::llround(target / spacing[axis]));
    return stride;
}

std::vector<Vec3> to_index(const Grid& grid, std::span<const Vec3> points_mm) {
    const Affine3 mm_to_index = grid.index_to_mm.inverse();
    std::vector<Vec3> result;
    for (const Vec3& p : points_mm)
        if (const Vec3 index = mm_to_index.apply(p); fits_index(index)) result.push_back(index);
    return result;
}

std::vector<Vec3> centers_mm(const ImplicitFunction& function) {
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < function.centers().size(); ++i)
        result.push_back(function.frame().center + function.frame().scale * function.centers()[i]);
    return result;
}

/// Size in voxels of the starts' box.
Vec3 extent(const Grid& grid, std::span<const Vec3> starts) {
    Box3 box;
    for (const Vec3& p : to_index(grid, starts)) box.extend(p);
    return box.size();
}

/// Whether the starts spread over too few voxels, or the grid has too few, for a coarse lattice to save values.
bool is_small(const Grid& grid, std::span<const Vec3> starts) {
    const Vec3 size = extent(grid, starts);
    std::array<double, 3> extents;
    for (int axis = 0; axis < 3; ++axis)
        extents[static_cast<std::size_t>(axis)] = std::min(size[axis], static_cast<double>(grid.size[axis]));
    std::sort(extents.begin(), extents.end());
    return extents[1] < kLeastExtentVoxels;
}

std::uint64_t key(const Index3& c) {
    constexpr std::int64_t bias = 2;
    return static_cast<std::uint64_t>((c.i + bias) | (c.j + bias) << 21 | (c.k + bias) << 42);
}

/// How many voxels a surface passes at least in the coarse cells that its starts are in. Many small objects have far more
/// surface than one that fills their box.
double voxels_about(const Grid& grid, std::span<const Vec3> starts) {
    const Index3 stride = strides(grid);
    std::unordered_set<std::uint64_t> cells;
    for (const Vec3& index : to_index(grid, starts)) {
        const Index3 voxel = cell_of(index);
        if (voxel.i >= -1 && voxel.i < grid.size.i && voxel.j >= -1 && voxel.j < grid.size.j && voxel.k >= -1 &&
            voxel.k < grid.size.k)
            cells.insert(key({(voxel.i + 1) / stride.i, (voxel.j + 1) / stride.j, (voxel.k + 1) / stride.k}));
    }
    const std::int64_t face = std::min({stride.i * stride.j, stride.j * stride.k, stride.k * stride.i});
    return static_cast<double>(cells.size()) * static_cast<double>(face);
}

class AdaptiveTracker {
public:
    AdaptiveTracker(FastFunction& function, const Grid& grid, std::span<const Vec3> starts, Doubts doubts, const Work& work)
        : grid_(grid),
          starts_(starts),
          doubts_(doubts),
          work_(work),
          fast_(function),
          coarse_(grid, strides(grid)),
          cubics_(coarse_),
          fine_(grid) {
        const Vec3 spacing = grid.spacing_mm();
        for (int axis = 0; axis < 3; ++axis)
            if (coarse_.stride()[axis] > 1)
                coarse_spacing_mm_ =
                    std::max(coarse_spacing_mm_, spacing[axis] * static_cast<double>(coarse_.stride()[axis]));
    }

    SurfaceLattice run() {
        find_band();
        interpolate_band();
        work_.report("voxelize", 0.4);
        if (doubts_ == Doubts::resolved) {
            doubt_near_centres();
            doubt_at_starts();
            for (int pass = 0; pass < kPasses && resolve_doubts(); ++pass) spread_errors();
        }
        work_.report("voxelize", 0.8);
        SurfaceLattice surface = track_surface(
            std::move(fine_),
            [this](std::span<const Vec3> points, std::span<double> values) { evaluate_signs(points, values); }, starts_,
            work_);
        surface.evaluations = evaluations_;
        return surface;
    }

private:
    struct BandCell {
        Index3 cell;
        double doubt_mm = 0;     ///< smaller values are to be computed
        double resolved_mm = 0;  ///< ... and have been, up to this
        double error_mm = 0;     ///< largest found
    };

    void find_band() {
        std::vector<Index3> starts;
        for (const Vec3& index : to_index(grid_, starts_)) starts.push_back(coarse_.cell_at(index));
        const auto evaluate = [this](std::span<const Vec3> points, std::span<double> values) {
            fast_.values(points, values, work_);
        };
        const auto [cells, evaluations] = flood_coarse_cells(
            coarse_, evaluate, starts, {kCoarseBulge * coarse_spacing_mm_, CoarseValues::stencils}, work_);
        evaluations_ += evaluations;
        for (const Index3& cell : cells) {
            numbers_.emplace(key(cell), band_.size());
            band_.push_back({cell, kDoubtElsewhere * coarse_spacing_mm_});
        }
    }

    void interpolate_band() {
        for (const BandCell& band : band_) fine_.reserve(lowest(band.cell), highest(band.cell));
        for_each_cell([&](std::size_t b) {
            const BandCell& band = band_[b];
            std::vector<double> values;
            cubics_.interpolate(band.cell, values);
            const Index3& s = coarse_.stride();
            for_each_point(band.cell, [&](const Index3& p) {
                const Index3 at{p.i - band.cell.i * s.i, p.j - band.cell.j * s.j, p.k - band.cell.k * s.k};
                // Points between cells are set by several, but to the same value.
                fine_.set_reserved(p, values[static_cast<std::size_t>(at.i + (s.i + 1) * (at.j + (s.j + 1) * at.k))]);
            });
        });
    }

    void doubt_near_centres() {
        for (const Vec3& index : to_index(grid_, centers_mm(fast_.exact()))) {
            const Index3 cell = coarse_.cell_at(index);
            for_each_neighbour(cell, [&](BandCell& near) {
                const double fraction = near.cell == cell ? kDoubtAtCentres : kDoubtBesideCentres;
                near.doubt_mm = std::max(near.doubt_mm, fraction * coarse_spacing_mm_);
            });
        }
    }

    /// f is 0 at the starts, so the interpolant's value there is its error.
    void doubt_at_starts() {
        for (const Vec3& index : to_index(grid_, starts_)) {
            const Index3 cell = coarse_.cell_at(index);
            const auto entry = numbers_.find(key(cell));
            if (!coarse_.is_cell(cell) || entry == numbers_.end()) continue;
            Vec3 fraction;
            for (int axis = 0; axis < 3; ++axis)
                fraction[axis] = index[axis] / static_cast<double>(coarse_.stride()[axis]) - static_cast<double>(cell[axis]);
            BandCell& band = band_[entry->second];
            band.error_mm = std::max(band.error_mm, std::abs(cubics_.interpolate_at(cell, fraction)));
        }
        spread_errors();
    }

    void spread_errors() {
        std::vector<double> errors;
        for (const BandCell& band : band_) errors.push_back(band.error_mm);
        for (std::size_t b = 0; b < band_.size(); ++b) {
            band_[b].doubt_mm = std::max(band_[b].doubt_mm, kDoubtPerError * errors[b]);
            // A neighbour has at least this much doubt already.
            if (kDoubtPerError / 2 * errors[b] <= kDoubtElsewhere * coarse_spacing_mm_) continue;
            for_each_neighbour(band_[b].cell, [&](BandCell& near) {
                near.doubt_mm = std::max(near.doubt_mm, kDoubtPerError / 2 * errors[b]);
            });
        }
    }

    /// Computes the values in doubt that have not been; true if there were any.
    bool resolve_doubts() {
        std::vector<std::vector<Index3>> doubtful_nodes(band_.size());
        for_each_cell([&](std::size_t b) {
            BandCell& band = band_[b];
            if (band.doubt_mm <= band.resolved_mm) return;
            band.resolved_mm = band.doubt_mm;
            for_each_point(band.cell, [&](const Index3& p) {
                if (!is_node(p) && std::abs(fine_.value(p)) < band.doubt_mm) doubtful_nodes[b].push_back(p);
            });
        });
        std::vector<Index3> points;
        std::vector<std::size_t> cells;
        for (std::size_t b = 0; b < band_.size(); ++b)
            for (const Index3& p : doubtful_nodes[b]) {
                if (!fine_.mark_point(p)) continue;
                points.push_back(p);
                cells.push_back(b);
            }
        std::vector<Vec3> positions;
        positions.reserve(points.size());
        for (const Index3& p : points) positions.push_back(grid_.center_mm(p.i, p.j, p.k));
        std::vector<double> values(points.size());
        evaluate_signs(positions, values);
        for (std::size_t i = 0; i < points.size(); ++i) {
            BandCell& band = band_[cells[i]];
            band.error_mm = std::max(band.error_mm, std::abs(values[i] - fine_.value(points[i])));
            fine_.set_value(points[i], values[i]);
        }
        return !points.empty();
    }

    /// Values with the right sign: where the fast function is in doubt, the direct sum.
    void evaluate_signs(std::span<const Vec3> points, std::span<double> values) {
        fast_.values(points, values, work_);
        evaluations_ += static_cast<std::int64_t>(points.size());
        if (fast_.is_direct()) return;
        std::vector<std::size_t> unsure;
        std::vector<Vec3> positions;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (std::abs(values[i]) <= kUnsurePerError * fast_.error_mm()) {
                unsure.push_back(i);
                positions.push_back(points[i]);
            }
        std::vector<double> exact(positions.size());
        fast_.exact().values(positions, exact, work_);
        for (std::size_t u = 0; u < unsure.size(); ++u) values[unsure[u]] = exact[u];
        evaluations_ += static_cast<std::int64_t>(positions.size());
    }

    bool is_node(const Index3& p) const {
        return p.i % coarse_.stride().i == 0 && p.j % coarse_.stride().j == 0 && p.k % coarse_.stride().k == 0;
    }

    /// Calls visit(number) for all cells of the band, in parallel.
    template <typename Visit>
    void for_each_cell(const Visit& visit) {
        parallel_for(static_cast<std::int64_t>(band_.size()), 32, work_, [&](std::int64_t begin, std::int64_t end) {
            for (; begin < end; ++begin) visit(static_cast<std::size_t>(begin));
        });
    }

    /// The points of the grid in a coarse cell and on its faces.
    Index3 lowest(const Index3& cell) const {
        Index3 low;
        for (int axis = 0; axis < 3; ++axis) low[axis] = std::max<std::int64_t>(cell[axis] * coarse_.stride()[axis], 0);
        return low;
    }
    Index3 highest(const Index3& cell) const {
        Index3 high;
        for (int axis = 0; axis < 3; ++axis)
            high[axis] = std::min((cell[axis] + 1) * coarse_.stride()[axis], grid_.size[axis] - 1);
        return high;
    }

    /// Calls visit(point) for them, i fastest.
    template <typename Visit>
    void for_each_point(const Index3& cell, const Visit& visit) const {
        const Index3 low = lowest(cell), high = highest(cell);
        for (std::int64_t k = low.k; k <= high.k; ++k)
            for (std::int64_t j = low.j; j <= high.j; ++j)
                for (std::int64_t i = low.i; i <= high.i; ++i) visit(Index3{i, j, k});
    }

    /// Calls visit(band cell) for a coarse cell and the 26 around it, as far as they are in the band.
    template <typename Visit>
    void for_each_neighbour(const Index3& cell, const Visit& visit) {
        for (std::int64_t k = -1; k <= 1; ++k)
            for (std::int64_t j = -1; j <= 1; ++j)
                for (std::int64_t i = -1; i <= 1; ++i) {
                    const Index3 c{cell.i + i, cell.j + j, cell.k + k};
                    if (!coarse_.is_cell(c)) continue;
                    if (const auto entry = numbers_.find(key(c)); entry != numbers_.end()) visit(band_[entry->second]);
                }
    }

    const Grid& grid_;
    std::span<const Vec3> starts_;
    Doubts doubts_;
    const Work& work_;
    FastFunction& fast_;
    CoarseLattice coarse_;
    CubicCells cubics_;
    Lattice fine_;
    double coarse_spacing_mm_ = 0;
    std::vector<BandCell> band_;
    std::unordered_map<std::uint64_t, std::size_t> numbers_;  ///< coarse cell -> band_
    std::int64_t evaluations_ = 0;
};

}  // namespace

std::int64_t expected_surface_voxels(const Grid& grid, std::span<const Vec3> starts) {
    constexpr double kMost = 1e15;  // far beyond any lattice, far from what 64 bits hold
    Box3 box;
    for (const Vec3& p : to_index(grid, starts)) box.extend(p);
    Vec3 half;
    for (int axis = 0; axis < 3; ++axis) {  // no more of it than lies in the grid
        const double low = std::max(box.min[axis], -0.5);
        const double high = std::min(box.max[axis], static_cast<double>(grid.size[axis]) - 0.5);
        half[axis] = std::max(high - low, 0.0) / 2;
    }
    const double voxels = 4.0 / 3 * M_PI * (half.x * half.y + half.y * half.z + half.z * half.x);
    return std::llround(std::min(std::max(voxels, voxels_about(grid, starts)), kMost));
}

SurfaceLattice track_surface_adaptively(FastFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work, Doubts doubts) {
    check_grid(grid);
    if (is_small(grid, starts)) return track_surface(function.exact(), grid, starts, work);
    work.report("voxelize", 0);
    return AdaptiveTracker(function, grid, starts, doubts, work).run();
}

SurfaceLattice track_surface_adaptively(const ImplicitFunction& function, const Grid& grid, std::span<const Vec3> starts,
                                        const Work& work) {
    check_grid(grid);
    FastFunction fast(function, {.tolerance_mm = kFastTolerance * smallest(grid.spacing_mm()),
                                 .expected_points = expected_surface_voxels(grid, starts)});
    return track_surface_adaptively(fast, grid, starts, work);
}

}  // namespace kontur
