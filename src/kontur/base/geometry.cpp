// SPDX-License-Identifier: Apache-2.0
#include "kontur/base/geometry.h"

#include <algorithm>

#include "kontur/base/error.h"

namespace kontur {
namespace {

/// Eigenvector of the smallest eigenvalue of a symmetric 3x3 matrix, by cyclic Jacobi rotations; `middle` receives the
/// ratio of the middle to the largest eigenvalue.
Vec3 smallest_eigenvector(std::array<std::array<double, 3>, 3> a, double& middle) {
    std::array<std::array<double, 3>, 3> v{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < 32; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0) continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1));
                const double c = 1 / std::sqrt(t * t + 1), s = t * c;
                for (int r = 0; r < 3; ++r) {
                    const double rp = a[r][p], rq = a[r][q];
                    a[r][p] = c * rp - s * rq;
                    a[r][q] = s * rp + c * rq;
                }
                for (int r = 0; r < 3; ++r) {
                    const double pr = a[p][r], qr = a[q][r];
                    a[p][r] = c * pr - s * qr;
                    a[q][r] = s * pr + c * qr;
                    const double vp = v[r][p], vq = v[r][q];
                    v[r][p] = c * vp - s * vq;
                    v[r][q] = s * vp + c * vq;
                }
            }
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int l, int r) { return a[l][l] < a[r][r]; });
    const double largest = a[order[2]][order[2]];
    middle = largest > 0 ? a[order[1]][order[1]] / largest : 0;
    return {v[0][order[0]], v[1][order[0]], v[2][order[0]]};
}

}  // namespace

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 edge = b - a;
    const double square = dot(edge, edge);
    const double t = square > 0 ? std::clamp(dot(p - a, edge) / square, 0.0, 1.0) : 0.0;
    return distance(p, a + t * edge);
}

Vec3 any_perpendicular(const Vec3& normal) {
    const Vec3 magnitude{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    Vec3 axis{1, 0, 0};
    if (magnitude.y < magnitude.x && magnitude.y <= magnitude.z) axis = {0, 1, 0};
    else if (magnitude.z < magnitude.x && magnitude.z < magnitude.y) axis = {0, 0, 1};
    return normalized(axis - dot(axis, normal) * normal);
}

void Box3::extend(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], p[axis]);
        max[axis] = std::max(max[axis], p[axis]);
    }
}

Box3 Box3::padded(double margin) const {
    const Vec3 m{margin, margin, margin};
    return {min - m, max + m};
}

double line_length(std::span<const Vec3> points, bool closed) {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += distance(points[i - 1], points[i]);
    return closed && !points.empty() ? length + distance(points.back(), points.front()) : length;
}

Box3 bounding_box(std::span<const Vec3> points) {
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    return box;
}

void Affine3::set_column(int axis, const Vec3& v) {
    for (int row = 0; row < 3; ++row) linear[row][axis] = v[row];
}

double Affine3::determinant() const { return dot(column(0), cross(column(1), column(2))); }

Affine3 Affine3::inverse() const {
    const Vec3 a = column(0), b = column(1), c = column(2);
    const double det = dot(a, cross(b, c));
    const double scale = norm(a) * norm(b) * norm(c);
    if (!std::isfinite(det) || !is_finite(translation) || !(std::abs(det) > 1e-12 * scale))
        throw Error(ErrorKind::invalid_input, "the axes of the grid are not finite or linearly dependent");
    const std::array rows{cross(b, c) / det, cross(c, a) / det, cross(a, b) / det};
    Affine3 result;
    for (int r = 0; r < 3; ++r) result.linear[r] = {rows[r].x, rows[r].y, rows[r].z};
    result.translation = -result.apply_linear(translation);
    return result;
}

Affine3 compose(const Affine3& first, const Affine3& second) {
    Affine3 result;
    for (int axis = 0; axis < 3; ++axis) result.set_column(axis, first.apply_linear(second.column(axis)));
    result.translation = first.apply(second.translation);
    return result;
}

Plane make_plane(const Vec3& origin, const Vec3& normal) {
    Plane plane;
    plane.origin = origin;
    plane.normal = normalized(normal);
    plane.u = any_perpendicular(plane.normal);
    plane.v = cross(plane.normal, plane.u);
    return plane;
}

std::optional<Plane> fit_plane(std::span<const Vec3> points) {
    if (points.size() < 3) return std::nullopt;
    Vec3 mean;
    for (const Vec3& p : points) mean += p;
    mean *= 1.0 / static_cast<double>(points.size());

    std::array<std::array<double, 3>, 3> covariance{};
    Vec3 area;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 d = points[i] - mean;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) covariance[r][c] += d[r] * d[c];
        area += cross(d, points[(i + 1) % points.size()] - mean);
    }
    double middle = 0;
    Vec3 normal = smallest_eigenvector(covariance, middle);
    if (!(middle > 1e-12)) return std::nullopt;
    if (dot(normal, area) < 0) normal = -normal;
    return make_plane(mean, normal);
}

}  // namespace kontur
