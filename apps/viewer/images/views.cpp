// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kontur::viewer {
namespace {

Vec3 middle_voxel_mm(const Grid& grid) { return grid.center_mm(grid.size.i / 2, grid.size.j / 2, grid.size.k / 2); }

/// The grid's axes in the order sagittal, coronal, axial: the permutation that agrees best with the patient's axes.
std::array<int, 3> axes_by_kind(const Grid& grid) {
    std::array<int, 3> order{0, 1, 2}, best = order;
    double best_sum = -1;
    do {
        double sum = 0;
        for (int patient = 0; patient < 3; ++patient)
            sum += std::abs(normalized(grid.index_to_mm.column(order[patient]))[patient]);
        if (sum > best_sum) best_sum = sum, best = order;
    } while (std::next_permutation(order.begin(), order.end()));
    return best;
}

/// Across which axis the image was taken slice by slice.
int slice_axis(const Grid& grid) {
    constexpr double kByFar = 1.2;
    const Vec3 spacing = grid.spacing_mm();
    for (int axis = 0; axis < 2; ++axis)
        if (spacing[axis] > kByFar * std::max(spacing[(axis + 1) % 3], spacing[(axis + 2) % 3])) return axis;
    return 2;
}

Vec3 aligned(const Vec3& direction, const Vec3& like) { return dot(direction, like) < 0 ? -direction : direction; }

/// Extent and scroll range of the grid seen on the plane.
View measured(const Grid& grid, const Plane& plane) {
    const double step_mm = slice_step_mm(grid, plane.normal);
    Box3 box;
    for (const Vec3& corner : outer_corners(grid)) {
        const auto [u, v] = plane.to_uv(corner);
        box.extend({u, v, plane.distance_to(corner)});
    }
    const auto steps = [&](double mm) { return std::floor(std::max(0.0, mm - 0.499 * step_mm) / step_mm) * step_mm; };
    return {plane, step_mm, box.size().x, box.size().y, -steps(-box.min.z), steps(box.max.z)};
}

}  // namespace

std::array<Vec3, 8> outer_corners(const Grid& grid) {
    std::array<Vec3, 8> corners;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 index;
        for (int axis = 0; axis < 3; ++axis)
            index[axis] = (corner >> axis & 1) ? static_cast<double>(grid.size[axis]) - 0.5 : -0.5;
        corners[static_cast<std::size_t>(corner)] = grid.index_to_mm.apply(index);
    }
    return corners;
}

double slice_step_mm(const Grid& grid, const Vec3& normal) {
    constexpr double kCosine = 0.99985;
    const Vec3 spacing = grid.spacing_mm();
    double step = std::min({spacing.x, spacing.y, spacing.z});
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 a = grid.index_to_mm.column((axis + 1) % 3), b = grid.index_to_mm.column((axis + 2) % 3);
        if (std::abs(dot(normalized(cross(a, b)), normal)) > kCosine)
            step = std::abs(dot(grid.index_to_mm.column(axis), normal));
    }
    return step;
}

View view_of(const Grid& grid, SliceKind kind) {
    const Plane screen = screen_plane(kind, middle_voxel_mm(grid));
    const std::array<int, 3> axes = axes_by_kind(grid);
    const auto patient_axis = [](const Vec3& d) { return std::abs(d.x) > 0.5 ? 0 : std::abs(d.y) > 0.5 ? 1 : 2; };
    const Vec3 column_u = grid.index_to_mm.column(axes[patient_axis(screen.u)]);
    const Vec3 column_v = grid.index_to_mm.column(axes[patient_axis(screen.v)]);
    Plane plane;
    plane.origin = screen.origin;
    plane.normal = normalized(aligned(cross(column_u, column_v), screen.normal));
    plane.u = normalized(aligned(column_u, screen.u));
    plane.v = aligned(cross(plane.normal, plane.u), screen.v);
    return measured(grid, plane);
}

ViewNames view_names(const Grid& grid) {
    constexpr double kCosine = 0.9397;  // 20 degrees
    const auto is_straight = [&](SliceKind kind) {
        return std::abs(dot(view_of(grid, kind).plane.normal, screen_plane(kind, {}).normal)) > kCosine;
    };
    ViewNames names;
    if (is_straight(SliceKind::axial) && is_straight(SliceKind::sagittal) && is_straight(SliceKind::coronal)) return names;
    constexpr std::array kAcross{SliceKind::sagittal, SliceKind::coronal, SliceKind::axial};  // the patient's axes
    const std::array<int, 3> axes = axes_by_kind(grid);
    const int slices = slice_axis(grid), rows = slices == 0 ? 1 : 0;
    for (int patient = 0; patient < 3; ++patient) {
        const SliceKind kind = kAcross[patient];
        std::string& title = names.titles[static_cast<std::size_t>(kind)];
        title = axes[patient] == slices ? "Acquisition" : axes[patient] == rows ? "Column" : "Row";
        if (axes[patient] == slices) names.first = kind;
    }
    return names;
}

View oblique_view(const Grid& grid) {
    const Plane coronal = view_of(grid, SliceKind::coronal).plane;
    const double half = std::numbers::sqrt2 / 2;
    Plane plane = coronal;
    plane.u = normalized(half * (coronal.u + coronal.normal));
    plane.normal = aligned(normalized(cross(plane.u, plane.v)), coronal.normal);
    return measured(grid, plane);
}

std::pair<double, double> value_range(const Image& image) {
    return std::visit(
        [](const auto& samples) {
            double least = 0, most = 0;
            bool first = true;
            for (const auto s : samples) {
                const auto value = static_cast<double>(s);
                if (!std::isfinite(value)) continue;
                least = first ? value : std::min(least, value);
                most = first ? value : std::max(most, value);
                first = false;
            }
            return std::pair{least, most};
        },
        image.samples);
}

bool looks_like_ct(const Image& image) { return suggest_window(image) == Window{} && value_range(image).first <= -200; }

std::vector<WindowPreset> window_presets(const Image& image) {
    const std::pair<double, double> range = value_range(image);
    const Window all{0.5 * (range.first + range.second), std::max(range.second - range.first, 1.0)};
    if (!looks_like_ct(image)) return {{"Automatic", suggest_window(image)}, {"Full range", all}};
    return {{"Abdomen", {40, 350}}, {"Liver", {60, 160}},       {"Lung", {-600, 1500}}, {"Bone", {400, 1800}},
            {"Brain", {40, 80}},    {"Mediastinum", {50, 350}}, {"Full range", all}};
}

}  // namespace kontur::viewer
