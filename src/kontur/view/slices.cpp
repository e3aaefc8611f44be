// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/slices.h"

#include <algorithm>
#include <numbers>

namespace kontur {
namespace {

constexpr std::array kKinds{SliceKind::axial, SliceKind::coronal, SliceKind::sagittal};
constexpr double kParallelDeg = 5;

bool are_parallel(const Vec3& a, const Vec3& b) {
    static const double cosine = std::cos(kParallelDeg * std::numbers::pi / 180);
    return std::abs(dot(a, b)) >= cosine * norm(a) * norm(b);
}

double drawn_length(const Contour& contour) {
    double length = 0;
    for (std::size_t i = contour.closed ? 0 : 1; i < contour.points.size(); ++i)
        length += distance(contour.points[i], contour.points[i == 0 ? contour.points.size() - 1 : i - 1]);
    return length;
}

/// The plane through `origin` whose frame results from turning the patient's axes until the screen plane of the nearest
/// anatomical kind is perpendicular to `normal`.
Plane turned_plane(SliceKind kind, const Vec3& normal, const Vec3& origin) {
    const Plane from = screen_plane(slice_kind(normal), origin);
    const Vec3 n = dot(normal, from.normal) < 0 ? -normalized(normal) : normalized(normal);
    const Vec3 u = normalized(from.u - dot(from.u, n) * n), v = cross(n, u);
    const auto turned = [&](const Vec3& d) { return dot(d, from.u) * u + dot(d, from.v) * v + dot(d, from.normal) * n; };
    const Plane straight = screen_plane(kind, origin);
    return {origin, turned(straight.normal), turned(straight.u), turned(straight.v)};
}

/// The direction that one of the three slices shall be perpendicular to: that of a tilted stack of contours, else the
/// patient's axis.
Vec3 leading_normal(const ContourSet& set) {
    constexpr Vec3 kPatientAxis{0, 0, 1};
    Vec3 longest = kPatientAxis;
    double longest_length = 0;
    for (const Contour& contour : set.contours) {
        if (obliquity_deg(contour.plane.normal) <= kParallelDeg) return kPatientAxis;
        if (const double length = drawn_length(contour); length > longest_length)
            longest = contour.plane.normal, longest_length = length;
    }
    double stack_length = 0, total_length = 0;
    for (const Contour& contour : set.contours) {
        const double length = drawn_length(contour);
        total_length += length;
        if (are_parallel(contour.plane.normal, longest)) stack_length += length;
    }
    return stack_length > 0.5 * total_length ? longest : kPatientAxis;
}

double slice_thickness_mm(const Image* image, const Vec3& normal) {
    if (!image) return 1;
    double thickness = 0;
    for (int axis = 0; axis < 3; ++axis)
        thickness = std::max(thickness, std::abs(dot(normal, image->grid.index_to_mm.column(axis))));
    return thickness;
}

/// Distance from `slice.plane` to the parallel plane in which the greatest length was drawn; the nearest of equals.
double best_offset_mm(const Slice& slice, const ContourSet& set) {
    struct Candidate {
        double offset, length;
    };
    std::vector<Candidate> candidates;
    for (const Contour& contour : set.contours) {
        if (contour.points.empty()) continue;
        Slice at = slice;
        at.plane.origin += slice.plane.distance_to(contour.points.front()) * slice.plane.normal;
        if (at.contains(contour))
            candidates.push_back({slice.plane.distance_to(contour.points.front()), drawn_length(contour)});
    }
    Candidate best{0, 0};
    for (const Candidate& at : candidates) {
        double length = 0;
        for (const Candidate& other : candidates)
            if (std::abs(other.offset - at.offset) <= 0.5 * slice.thickness_mm) length += other.length;
        const bool nearer = length == best.length && std::abs(at.offset) < std::abs(best.offset);
        if (length > best.length || nearer) best = {at.offset, length};
    }
    return best.offset;
}

/// The object's box in the plane's frame: u, v, and along the normal.
Box3 box_in_frame(const Plane& plane, const TriangleMesh& mesh, const ContourSet& set) {
    Box3 box;
    const auto extend = [&](const Vec3& p) {
        const auto [u, v] = plane.to_uv(p);
        box.extend({u, v, plane.distance_to(p)});
    };
    for (const Vec3& p : mesh.points) extend(p);
    for (const Contour& contour : set.contours)
        for (const Vec3& p : contour.points) extend(p);
    return box;
}

}  // namespace

bool Slice::contains(const Contour& contour) const {
    return !contour.points.empty() && std::all_of(contour.points.begin(), contour.points.end(), [&](const Vec3& p) {
        return std::abs(plane.distance_to(p)) <= 0.5 * thickness_mm;
    });
}

std::array<Slice, 3> choose_slices(const TriangleMesh& mesh, const ContourSet& contours, const Image* image) {
    const Vec3 leading = leading_normal(contours);
    std::array<Slice, 3> slices;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        Slice& slice = slices[i];
        slice.kind = kKinds[i];
        slice.plane = turned_plane(slice.kind, leading, {});
        slice.thickness_mm = slice_thickness_mm(image, slice.plane.normal);
        const Box3 box = box_in_frame(slice.plane, mesh, contours);
        if (box.is_empty()) continue;
        const Vec3 middle = box.center();
        slice.width_mm = box.size().x;
        slice.height_mm = box.size().y;
        slice.plane.origin = slice.plane.from_uv(middle.x, middle.y) + middle.z * slice.plane.normal;
        slice.plane.origin += best_offset_mm(slice, contours) * slice.plane.normal;
    }
    return slices;
}

}  // namespace kontur
