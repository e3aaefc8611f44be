// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/slice_contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/extract/isolines.h"
#include "kontur/extract/sign_change.h"

namespace kontur {
namespace {

/// One slice as a lattice of voxel centres. Its axes are the grid's steps, so that (u, v) are the voxel indices i and j.
IsolineLattice lattice_of(const Grid& grid, std::int64_t k) {
    const Vec3 u = grid.index_to_mm.column(0), v = grid.index_to_mm.column(1);
    IsolineLattice lattice;
    lattice.plane = {grid.center_mm(0, 0, k), normalized(cross(u, v)), u, v};
    lattice.columns = grid.size.i;
    lattice.rows = grid.size.j;
    return lattice;
}

/// The slice's plane with orthonormal axes.
Plane plane_of(const IsolineLattice& lattice) {
    Plane plane = lattice.plane;
    plane.u = normalized(plane.u);
    plane.v = cross(plane.normal, plane.u);
    return plane;
}

/// The voxel centres of a slice, their function values where they are known and the side of the surface elsewhere.
class MaskSlice {
public:
    MaskSlice(const Mask& mask, std::int64_t k)
        : grid_(mask.grid), k_(k), levels_(static_cast<std::size_t>(grid_.size.i * grid_.size.j)) {
        const auto first = mask.values.begin() + static_cast<std::ptrdiff_t>(grid_.offset(0, 0, k));
        std::transform(first, first + static_cast<std::ptrdiff_t>(levels_.size()), levels_.begin(),
                       [](std::uint8_t inside) { return inside ? 1.0 : -1.0; });
    }

    bool is_empty() const {
        return std::all_of(levels_.begin(), levels_.end(), [](double level) { return level < 0; });
    }

    /// Evaluates the function at the centres that have a neighbour on the other side: the lines pass nowhere else.
    void evaluate_border(const ImplicitFunction& function) {
        std::vector<std::size_t> border;
        std::vector<Vec3> points;
        for (std::int64_t j = 0; j < grid_.size.j; ++j)
            for (std::int64_t i = 0; i < grid_.size.i; ++i)
                if (is_border(i, j)) {
                    border.push_back(offset(i, j));
                    points.push_back(grid_.center_mm(i, j, k_));
                }
        std::vector<double> values(points.size());
        function.values(points, values, {.threads = 1});
        for (std::size_t n = 0; n < border.size(); ++n) levels_[border[n]] = values[n];
    }

    const std::vector<double>& levels() const { return levels_; }
    bool contains(const std::array<double, 2>& index) const {
        return index[0] >= 0 && index[1] >= 0 && index[0] < static_cast<double>(grid_.size.i) &&
               index[1] < static_cast<double>(grid_.size.j);
    }
    double level(double i, double j) const {
        return levels_[offset(static_cast<std::int64_t>(i), static_cast<std::int64_t>(j))];
    }

private:
    std::size_t offset(std::int64_t i, std::int64_t j) const { return static_cast<std::size_t>(i + grid_.size.i * j); }
    bool is_border(std::int64_t i, std::int64_t j) const {
        const bool in = levels_[offset(i, j)] > 0;
        const auto differs = [&](std::int64_t a, std::int64_t b) {
            return a >= 0 && b >= 0 && a < grid_.size.i && b < grid_.size.j && (levels_[offset(a, b)] > 0) != in;
        };
        return differs(i - 1, j) || differs(i + 1, j) || differs(i, j - 1) || differs(i, j + 1);
    }

    const Grid& grid_;
    std::int64_t k_;
    std::vector<double> levels_;
};

/// A point of a line between two voxel centres, indices (i, j), of which the surface separates one from the other.
using Crossing = SignChange<std::array<double, 2>>;

std::array<double, 2> zero_of(const Crossing& crossing) {
    const double t = crossing.zero();
    return {crossing.low[0] + t * (crossing.high[0] - crossing.low[0]),
            crossing.low[1] + t * (crossing.high[1] - crossing.low[1])};
}

/// Points beyond the grid's outermost centres, where it cuts the object off, stay where they are.
std::optional<Crossing> crossing_at(const std::array<double, 2>& point, const MaskSlice& slice) {
    Crossing crossing{{std::floor(point[0]), std::floor(point[1])}, {std::ceil(point[0]), std::ceil(point[1])}};
    if (crossing.low == crossing.high || !slice.contains(crossing.low) || !slice.contains(crossing.high))
        return std::nullopt;
    crossing.low_value = slice.level(crossing.low[0], crossing.low[1]);
    crossing.high_value = slice.level(crossing.high[0], crossing.high[1]);
    if ((crossing.low_value > 0) == (crossing.high_value > 0)) return std::nullopt;
    return crossing;
}

/// Moves the lines' points from where linear interpolation put them to the function's zeros; all of them step by step,
/// because the function is several times cheaper in bulk.
void settle_points(std::vector<Isoline>& lines, const MaskSlice& slice, const ImplicitFunction& function,
                   const Plane& plane) {
    constexpr int kSteps = 8;  // leaves less than 1e-6 of a voxel where the surface is as smooth as fits are
    std::vector<Crossing> crossings;
    std::vector<std::array<double, 2>*> points;
    for (Isoline& line : lines)
        for (std::array<double, 2>& point : line.points)
            if (const auto crossing = crossing_at(point, slice)) {
                crossings.push_back(*crossing);
                points.push_back(&point);
            }
    std::vector<Vec3> places(points.size());
    std::vector<double> values(points.size());
    for (int step = 0; step < kSteps; ++step) {
        for (std::size_t n = 0; n < points.size(); ++n) places[n] = plane.from_uv((*points[n])[0], (*points[n])[1]);
        function.values(places, values, {.threads = 1});
        for (std::size_t n = 0; n < points.size(); ++n) {
            crossings[n].narrow(*points[n], values[n]);
            *points[n] = zero_of(crossings[n]);
        }
    }
}

std::vector<Contour> contours_of_slice(const Mask& mask, const ImplicitFunction& function, std::int64_t k) {
    MaskSlice slice(mask, k);
    if (slice.is_empty()) return {};
    slice.evaluate_border(function);
    const IsolineLattice lattice = lattice_of(mask.grid, k);
    std::vector<Isoline> lines = isolines(lattice, slice.levels());
    settle_points(lines, slice, function, lattice.plane);
    const Plane plane = plane_of(lattice);
    ContourSet set;
    for (const Isoline& line : lines) {
        Contour& contour = set.contours.emplace_back(Contour{.plane = plane, .points = {}, .hole = line.hole});
        for (const auto& [i, j] : line.points) contour.points.push_back(lattice.plane.from_uv(i, j));
    }
    drop_duplicate_points(set);  // lines that meet a centre at which the function is 0
    return std::move(set.contours);
}

}  // namespace

ContourSet slice_contours(const Mask& mask, const ImplicitFunction& function, const Work& work) {
    check_mask(mask);
    constexpr std::int64_t kSlicesAtOnce = 32;  // between two looks at the progress
    std::vector<std::vector<Contour>> slices(static_cast<std::size_t>(mask.grid.size.k));
    for (std::int64_t start = 0; start < mask.grid.size.k; start += kSlicesAtOnce) {
        work.report("slice", static_cast<double>(start) / static_cast<double>(mask.grid.size.k));
        const std::int64_t count = std::min(kSlicesAtOnce, mask.grid.size.k - start);
        parallel_for(count, 1, work, [&](std::int64_t first, std::int64_t end) {
            for (std::int64_t k = start + first; k < start + end; ++k)
                slices[static_cast<std::size_t>(k)] = contours_of_slice(mask, function, k);
        });
    }
    ContourSet set;
    for (std::vector<Contour>& contours : slices)
        std::move(contours.begin(), contours.end(), std::back_inserter(set.contours));
    work.report("slice", 1);
    return set;
}

}  // namespace kontur
