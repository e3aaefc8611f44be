// SPDX-License-Identifier: Apache-2.0
#include "kontur/extract/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/extract/isolines.h"
#include "kontur/extract/tracker.h"
#include "kontur/shape/section.h"

namespace kontur {
namespace {

/// Trilinear interpolation of a mask, 0 outside of the grid.
class MaskSampler {
public:
    explicit MaskSampler(const Mask& mask) : mask_(mask), mm_to_index_(mask.grid.index_to_mm.inverse()) {}

    double operator()(const Vec3& point_mm) const noexcept {
        const Vec3 p = mm_to_index_.apply(point_mm);
        const Vec3 floor{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, t = p - floor;
        if (!near_grid(floor)) return 0;
        const Index3 a{static_cast<std::int64_t>(floor.x), static_cast<std::int64_t>(floor.y),
                       static_cast<std::int64_t>(floor.z)};
        double sum = 0;
        for (int dk = 0; dk < 2; ++dk)
            for (int dj = 0; dj < 2; ++dj)
                for (int di = 0; di < 2; ++di)
                    if (inside(a.i + di, a.j + dj, a.k + dk))
                        sum += (di ? t.x : 1 - t.x) * (dj ? t.y : 1 - t.y) * (dk ? t.z : 1 - t.z);
        return sum;
    }

private:
    bool near_grid(const Vec3& lower) const {
        for (int axis = 0; axis < 3; ++axis)
            if (!(lower[axis] >= -1 && lower[axis] < static_cast<double>(mask_.grid.size[axis]))) return false;
        return true;
    }
    bool inside(std::int64_t i, std::int64_t j, std::int64_t k) const {
        const Index3& n = mask_.grid.size;
        return i >= 0 && j >= 0 && k >= 0 && i < n.i && j < n.j && k < n.k && mask_.values[mask_.grid.offset(i, j, k)] != 0;
    }

    const Mask& mask_;
    Affine3 mm_to_index_;
};

/// Corners, in mm, of the index box around the object and its one voxel wide fall to 0; nullopt for an empty mask.
std::optional<BoxCorners> object_region(const Mask& mask) {
    Box3 box;
    const Index3& n = mask.grid.size;
    for (std::int64_t k = 0; k < n.k; ++k)
        for (std::int64_t j = 0; j < n.j; ++j) {
            const auto row = std::span(mask.values).subspan(mask.grid.offset(0, j, k), static_cast<std::size_t>(n.i));
            const auto set = [](std::uint8_t value) { return value != 0; };
            const auto first = std::ranges::find_if(row, set);
            if (first == row.end()) continue;
            const auto last = std::find_if(row.rbegin(), row.rend(), set).base() - 1;
            box.extend({static_cast<double>(first - row.begin()), static_cast<double>(j), static_cast<double>(k)});
            box.extend({static_cast<double>(last - row.begin()), static_cast<double>(j), static_cast<double>(k)});
        }
    if (box.is_empty()) return std::nullopt;
    BoxCorners region = corners(box.padded(1));
    for (Vec3& corner : region) corner = mask.grid.index_to_mm.apply(corner);
    return region;
}

bool is_frame(const Plane& plane) {
    constexpr double kTolerance = 1e-4;  // files round the axes to a few decimals
    const auto holds = [](double value, double target) { return std::abs(value - target) <= kTolerance; };
    return is_finite(plane.origin) && holds(norm(plane.u), 1) && holds(norm(plane.v), 1) && holds(norm(plane.normal), 1) &&
           holds(dot(plane.u, plane.v), 0) && holds(dot(plane.u, plane.normal), 0) && holds(dot(plane.v, plane.normal), 0);
}

void check_planes(std::span<const Plane> planes) {
    for (std::size_t p = 0; p < planes.size(); ++p)
        if (!is_frame(planes[p]))
            throw Error(ErrorKind::invalid_input,
                        "plane " + std::to_string(p + 1) + " of " + std::to_string(planes.size()) +
                            " has no finite origin or no orthonormal u, v and normal (within 0.0001)");
}

/// u and v as close as possible to those given, orthogonal to the normal and each other within rounding: a file's six
/// decimals would otherwise move points off their plane far from its origin.
Plane orthonormalized(Plane plane) {
    const bool left_handed = dot(cross(plane.u, plane.v), plane.normal) < 0;
    plane.normal = normalized(plane.normal);
    plane.u = normalized(plane.u - dot(plane.u, plane.normal) * plane.normal);
    plane.v = left_handed ? cross(plane.u, plane.normal) : cross(plane.normal, plane.u);
    return plane;
}

/// Ramer 1972 / Douglas & Peucker 1973 on a closed polygon, split at its first point and the point farthest from it.
std::vector<std::array<double, 2>> simplified(const std::vector<std::array<double, 2>>& points, double tolerance_mm) {
    const std::size_t count = points.size();
    const auto& at = [&](std::size_t i) -> const std::array<double, 2>& { return points[i % count]; };
    std::size_t far = 0;
    double farthest = 0;
    for (std::size_t i = 1; i < count; ++i)
        if (const double d = std::hypot(at(i)[0] - at(0)[0], at(i)[1] - at(0)[1]); d > farthest) farthest = d, far = i;
    if (farthest <= tolerance_mm) return {at(0)};

    std::vector<bool> keep(count);
    keep[0] = keep[far] = true;
    std::vector<std::array<std::size_t, 2>> open{{0, far}, {far, count}};
    while (!open.empty()) {
        const auto [begin, end] = open.back();
        open.pop_back();
        double worst = tolerance_mm;
        std::size_t split = 0;
        for (std::size_t i = begin + 1; i < end; ++i)
            if (const double d = distance_to_segment(at(i), at(begin), at(end)); d > worst) worst = d, split = i;
        if (split == 0) continue;
        keep[split] = true;
        open.push_back({begin, split});
        open.push_back({split, end});
    }
    std::vector<std::array<double, 2>> corners;
    for (std::size_t i = 0; i < count; ++i)
        if (keep[i]) corners.push_back(points[i]);
    return corners;
}

std::vector<double> sample_levels(const MaskSampler& sampler, const IsolineLattice& lattice, const Work& work) {
    std::vector<double> levels(static_cast<std::size_t>(lattice.node_count()));
    parallel_for(lattice.rows, 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t j = begin; j < end; ++j)
            for (std::int64_t i = 0; i < lattice.columns; ++i) {
                const auto [u, v] = lattice.uv(i, j);
                levels[static_cast<std::size_t>(i + j * lattice.columns)] = sampler(lattice.plane.from_uv(u, v)) - 0.5;
            }
    });
    return levels;
}

std::optional<Contour> to_contour(const Isoline& line, const Plane& plane, const TraceOptions& options) {
    if (line.area_mm2 < options.min_area_mm2) return std::nullopt;
    const auto points = simplified(line.points, options.tolerance_mm);
    if (points.size() < 3) return std::nullopt;
    Contour contour{.plane = plane, .points = {}, .hole = line.hole};
    for (const auto& [u, v] : points) contour.points.push_back(plane.from_uv(u, v));
    return contour;
}

void check_arguments(const Mask& mask, std::span<const Plane> planes, const TraceOptions& options) {
    check_mask(mask);
    for (const double option : {options.step_mm, options.tolerance_mm, options.min_area_mm2})
        if (!(option >= 0 && std::isfinite(option)))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("a trace option is {:g}; step_mm, tolerance_mm and min_area_mm2 must be >= 0", option));
    check_planes(planes);
}

double sampling_step_mm(const Grid& grid, const TraceOptions& options) {
    return options.step_mm > 0 ? options.step_mm : 0.5 * smallest(grid.spacing_mm());
}

}  // namespace

ContourSet trace(const Mask& mask, std::span<const Plane> planes, const TraceOptions& options, const Work& work) {
    check_arguments(mask, planes, options);
    ContourSet set;
    const std::optional<BoxCorners> region = object_region(mask);
    if (!region) return set;

    const MaskSampler sampler(mask);
    const double step_mm = sampling_step_mm(mask.grid, options);
    for (std::size_t p = 0; p < planes.size(); ++p) {
        work.report("trace", static_cast<double>(p) / static_cast<double>(planes.size()));
        const Plane plane = orthonormalized(planes[p]);
        const std::optional<IsolineLattice> lattice = lattice_over(plane, *region, step_mm);
        if (!lattice) continue;
        const std::vector<double> levels = sample_levels(sampler, *lattice, work);
        const auto exact = [&](double u, double v) { return sampler(plane.from_uv(u, v)) - 0.5; };
        for (const Isoline& line : isolines(*lattice, levels, exact))
            if (auto contour = to_contour(line, plane, options)) set.contours.push_back(std::move(*contour));
    }
    work.report("trace", 1);
    return set;
}

}  // namespace kontur
