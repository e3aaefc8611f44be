// SPDX-License-Identifier: Apache-2.0
#include "kontur/sureness/candidate_planes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr std::size_t kMostSlices = 24, kOffsets = 7;

/// Middle of a line and its direction of largest extent, in (u, v) of a plane.
struct LongAxis {
    std::array<double, 2> middle{};
    double angle = 0;
};

/// Of points with weights: the first principal axis.
LongAxis long_axis(const std::vector<std::array<double, 2>>& points, const std::vector<double>& weights) {
    LongAxis axis;
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t n = 0; n < points.size(); ++n)
        for (int c = 0; c < 2; ++c) axis.middle[c] += weights[n] / total * points[n][c];
    double uu = 0, uv = 0, vv = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const double u = points[n][0] - axis.middle[0], v = points[n][1] - axis.middle[1];
        uu += weights[n] * u * u;
        uv += weights[n] * u * v;
        vv += weights[n] * v * v;
    }
    axis.angle = 0.5 * std::atan2(2 * uv, uu - vv);
    return axis;
}

/// One of each pair of opposite ones, and with each its mirror images: whichever way the axes point, the set is the same.
std::vector<Vec3> directions_around(const std::array<Vec3, 3>& axes) {
    std::vector<Vec3> directions;
    for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b)
            for (int c = -2; c <= 2; ++c) {
                const bool is_first_of_pair = a > 0 || (a == 0 && (b > 0 || (b == 0 && c > 0)));
                if (!is_first_of_pair || std::gcd(std::gcd(a, b), c) != 1) continue;
                directions.push_back(normalized(double(a) * axes[0] + double(b) * axes[1] + double(c) * axes[2]));
            }
    return directions;
}

struct Range {
    double low, high;
};

Range range_along(const std::vector<Vec3>& points, const Vec3& normal) {
    Range range{dot(points.front(), normal), dot(points.front(), normal)};
    for (const Vec3& p : points) {
        range.low = std::min(range.low, dot(p, normal));
        range.high = std::max(range.high, dot(p, normal));
    }
    return range;
}

PlaneStack even_stack(const std::vector<Vec3>& points, const Vec3& normal) {
    const Range range = range_along(points, normal);
    PlaneStack stack{normal, {}, {}};
    for (std::size_t n = 0; n < kOffsets; ++n)
        stack.offsets_mm.push_back(range.low + (static_cast<double>(n) + 0.5) / kOffsets * (range.high - range.low));
    return stack;
}

/// The image's slices between the extremes of the points, evenly thinned.
PlaneStack slice_stack(const std::vector<Vec3>& points, const Grid& grid, int axis) {
    PlaneStack stack{slice_normal(grid, axis), {}, {}};
    const Range range = range_along(points, stack.normal);
    std::vector<ImageSlice> within;
    for (std::int64_t index = 0; index < grid.size[axis]; ++index) {
        const double offset = dot(slice_plane(grid, {axis, index}).origin, stack.normal);
        if (offset > range.low && offset < range.high) within.push_back({axis, index});
    }
    const std::size_t count = std::min(within.size(), kMostSlices);
    for (std::size_t n = 0; n < count; ++n) {
        const ImageSlice slice = within[(2 * n + 1) * within.size() / (2 * count)];
        stack.slices.push_back(slice);
        stack.offsets_mm.push_back(dot(slice_plane(grid, slice).origin, stack.normal));
    }
    return stack;
}

}  // namespace

std::string_view name(PlaneChoice choice) noexcept { return choice == PlaneChoice::any ? "any" : "image-slices"; }

Vec3 slice_normal(const Grid& grid, int axis) {
    return normalized(cross(grid.index_to_mm.column((axis + 1) % 3), grid.index_to_mm.column((axis + 2) % 3)));
}

Plane slice_plane(const Grid& grid, const ImageSlice& slice) {
    Vec3 middle{static_cast<double>(grid.size.i - 1) / 2, static_cast<double>(grid.size.j - 1) / 2,
                static_cast<double>(grid.size.k - 1) / 2};
    middle[slice.axis] = static_cast<double>(slice.index);
    Plane plane;
    plane.origin = grid.index_to_mm.apply(middle);
    plane.normal = slice_normal(grid, slice.axis);
    plane.u = normalized(grid.index_to_mm.column((slice.axis + 1) % 3));
    plane.v = cross(plane.normal, plane.u);
    return plane;
}

ImageSlice nearest_slice(const Grid& grid, int axis, const Vec3& p) {
    const double index = std::round(grid.index_to_mm.inverse().apply(p)[axis]);
    return {axis, static_cast<std::int64_t>(std::clamp(index, 0.0, static_cast<double>(grid.size[axis] - 1)))};
}

std::array<Vec3, 3> principal_axes(const std::vector<Vec3>& points) {
    const Plane flat = fit_plane(points).value_or(make_plane({}, {0, 0, 1}));
    std::vector<std::array<double, 2>> projected;
    for (const Vec3& p : points) projected.push_back(flat.to_uv(p));
    const double angle = long_axis(projected, std::vector<double>(points.size(), 1.0)).angle;
    const Vec3 along = std::cos(angle) * flat.u + std::sin(angle) * flat.v;
    return {along, cross(flat.normal, along), flat.normal};
}

std::vector<PlaneStack> candidate_planes(const std::vector<Vec3>& points, PlaneChoice choice,
                                         const std::optional<Grid>& grid) {
    std::vector<PlaneStack> stacks;
    if (points.empty()) return stacks;
    if (grid)
        for (int axis = 0; axis < 3; ++axis) stacks.push_back(slice_stack(points, *grid, axis));
    if (choice == PlaneChoice::any)
        for (const Vec3& normal : directions_around(principal_axes(points))) stacks.push_back(even_stack(points, normal));
    return stacks;
}

Plane plane_across(const ContourSet& contours) {
    const auto longest = std::max_element(contours.contours.begin(), contours.contours.end(),
                                          [](const Contour& a, const Contour& b) { return length_mm(a) < length_mm(b); });
    if (longest == contours.contours.end() || longest->points.empty())
        throw Error(ErrorKind::invalid_input, "there is no contour; at least 1 is needed to say where to draw next");
    const Plane plane = make_plane(longest->points.front(), longest->plane.normal);
    std::vector<std::array<double, 2>> middles;
    std::vector<double> lengths;
    const std::size_t count = longest->points.size();
    for (std::size_t n = 0; n < (longest->closed ? count : count - 1); ++n) {
        const Vec3 &from = longest->points[n], &to = longest->points[(n + 1) % count];
        middles.push_back(plane.to_uv(0.5 * (from + to)));
        lengths.push_back(distance(from, to));
    }
    const LongAxis axis = long_axis(middles, lengths);
    const Vec3 along = std::cos(axis.angle) * plane.u + std::sin(axis.angle) * plane.v;
    const Vec3 normal = cross(plane.normal, along);
    return {plane.from_uv(axis.middle), normal, along, cross(normal, along)};
}

}  // namespace kontur
