// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace kontur {

/// A point or direction. Points are millimetres in the patient frame LPS (DICOM) unless a name says otherwise.
struct Vec3 {
    double x = 0, y = 0, z = 0;

    double& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

    Vec3& operator+=(const Vec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
    Vec3& operator-=(const Vec3& b) { return *this = {x - b.x, y - b.y, z - b.z}; }
    Vec3& operator*=(double s) { return *this = {x * s, y * s, z * s}; }

    friend Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
    friend Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
    friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
    friend Vec3 operator*(Vec3 a, double s) { return a *= s; }
    friend Vec3 operator*(double s, Vec3 a) { return a *= s; }
    friend Vec3 operator/(Vec3 a, double s) { return a *= 1 / s; }
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec3& a) { return std::hypot(a.x, a.y, a.z); }
inline double distance(const Vec3& a, const Vec3& b) { return norm(a - b); }
/// The least and the largest of the three numbers.
inline double smallest(const Vec3& a) { return a.x < a.y ? (a.x < a.z ? a.x : a.z) : (a.y < a.z ? a.y : a.z); }
inline double largest(const Vec3& a) { return a.x > a.y ? (a.x > a.z ? a.x : a.z) : (a.y > a.z ? a.y : a.z); }
inline bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Distance of `p` from the segment between `a` and `b`, which may coincide.
double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// `a` scaled to length 1; the zero vector stays zero.
inline Vec3 normalized(const Vec3& a) {
    const double length = norm(a);
    return length > 0 ? a / length : Vec3{};
}

/// A unit vector perpendicular to the unit vector `normal`, chosen deterministically.
Vec3 any_perpendicular(const Vec3& normal);

/// Voxel indices or a grid's size along i, j, k.
struct Index3 {
    std::int64_t i = 0, j = 0, k = 0;

    std::int64_t& operator[](int axis) { return axis == 0 ? i : axis == 1 ? j : k; }
    std::int64_t operator[](int axis) const { return axis == 0 ? i : axis == 1 ? j : k; }

    friend bool operator==(const Index3&, const Index3&) = default;
};

/// The voxel at an offset into an array of `size` with i fastest.
inline Index3 index_at(std::size_t offset, const Index3& size) {
    const auto n = static_cast<std::int64_t>(offset);
    return {n % size.i, n / size.i % size.j, n / (size.i * size.j)};
}

/// An axis-aligned box in mm; default-constructed it is empty and grows by `extend`.
struct Box3 {
    Vec3 min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
             std::numeric_limits<double>::infinity()};
    Vec3 max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
             -std::numeric_limits<double>::infinity()};

    bool is_empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
    Vec3 size() const { return is_empty() ? Vec3{} : max - min; }
    Vec3 center() const { return 0.5 * (min + max); }
    /// Length of the space diagonal; 0 when empty.
    double diagonal() const { return norm(size()); }
    bool contains(const Vec3& p) const {
        return p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y && p.z >= min.z && p.z <= max.z;
    }

    void extend(const Vec3& p);
    /// The box grown by `margin` on every side.
    Box3 padded(double margin) const;
};

Box3 bounding_box(std::span<const Vec3> points);

/// Of the line through the points, mm; `closed`: with the edge from the last one to the first.
double line_length(std::span<const Vec3> points, bool closed);

/// x -> linear * x + translation. The columns of `linear` are the images of the unit vectors; shear and mirroring allowed.
struct Affine3 {
    std::array<std::array<double, 3>, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< row major
    Vec3 translation;

    Vec3 apply(const Vec3& p) const { return apply_linear(p) + translation; }
    Vec3 apply_linear(const Vec3& d) const {
        return {linear[0][0] * d.x + linear[0][1] * d.y + linear[0][2] * d.z,
                linear[1][0] * d.x + linear[1][1] * d.y + linear[1][2] * d.z,
                linear[2][0] * d.x + linear[2][1] * d.y + linear[2][2] * d.z};
    }
    Vec3 column(int axis) const { return {linear[0][axis], linear[1][axis], linear[2][axis]}; }
    void set_column(int axis, const Vec3& v);
    double determinant() const;
    /// Throws Error(invalid_input) when the axes are linearly dependent or not finite.
    Affine3 inverse() const;

    friend bool operator==(const Affine3&, const Affine3&) = default;
};

/// first(second(x)).
Affine3 compose(const Affine3& first, const Affine3& second);

/// A plane with an orthonormal frame: `u` x `v` = `normal` up to the handedness that the source declared.
struct Plane {
    Vec3 origin;
    Vec3 normal{0, 0, 1};
    Vec3 u{1, 0, 0};
    Vec3 v{0, 1, 0};

    /// Signed distance in mm, positive on the normal's side.
    double distance_to(const Vec3& p) const { return dot(normal, p - origin); }
    /// In-plane coordinates (u, v) in mm of the projection of `p`.
    std::array<double, 2> to_uv(const Vec3& p) const { return {dot(u, p - origin), dot(v, p - origin)}; }
    Vec3 from_uv(double s, double t) const { return origin + s * u + t * v; }
    Vec3 from_uv(const std::array<double, 2>& uv) const { return from_uv(uv[0], uv[1]); }

    friend bool operator==(const Plane&, const Plane&) = default;
};

/// The plane through `origin` with the given normal (any length > 0) and a deterministic right-handed frame.
Plane make_plane(const Vec3& origin, const Vec3& normal);

/// Least-squares plane through the points, normal by the polygon's area vector where that is well defined (Newell), so
/// that a closed polygon runs counter-clockwise about it. nullopt for fewer than 3 points or points on one line.
std::optional<Plane> fit_plane(std::span<const Vec3> points);

}  // namespace kontur
