// SPDX-License-Identifier: Apache-2.0
#include "kontur/bounds/empty_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kontur/base/smooth_step.h"
#include "kontur/bounds/plane_lattice.h"
#include "kontur/drawing/reconcile.h"

namespace kontur {
namespace {

constexpr double kReachedThrough = 0.02;  // of the ball's diameter

/// How far a contour reaches through a plane, in diameters of the ball: the lesser of both sides; 1 if it lies in the plane.
double reach_through(const Contour& contour, const Plane& plane, double diameter_mm) {
    if (contour.points.empty()) return 0;
    double above = 0, below = 0;
    for (const Vec3& p : contour.points) {
        const double off = plane.distance_to(p) / diameter_mm;
        above = std::max(above, off);
        below = std::max(below, -off);
    }
    return std::max(above, below) < kMarginFraction ? 1 : std::min(above, below);
}

/// The contour that contradicts the plane most, and by how much.
struct Contradiction {
    std::size_t contour = 0;
    double reach = 0;
};

Contradiction contradiction(const DrawnPlanes& planes, const Plane& empty) {
    Contradiction worst;
    for (std::size_t c = 0; c < planes.set.contours.size(); ++c)
        if (const double reach = reach_through(planes.set.contours[c], empty, planes.ball.diameter()); reach > worst.reach)
            worst = {c, reach};
    return worst;
}

class EmptyPlane {
public:
    EmptyPlane(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions, const Plane& plane)
        : planes_(planes), regions_(regions), normal_(plane.normal), center_(foot(plane, planes.ball.center)) {
        // Along what was drawn farthest from the ball's centre, so that the lattice turns with the drawing.
        Vec3 along;
        for (const Contour& contour : planes.set.contours)
            for (const Vec3& p : contour.points)
                if (const Vec3 across = foot(plane, p) - center_; norm(across) > norm(along)) along = across;
        u_ = norm(along) > 0 ? normalized(along) : plane.u;
        v_ = cross(normal_, u_);
    }

    std::vector<Bound> bounds(double belief) const {
        std::vector<Bound> bounds;
        const PlaneLattice lattice(planes_.ball, distance(center_, planes_.ball.center));
        lattice.for_each_place([&](double x, double y) {
            const Vec3 place = center_ + x * u_ + y * v_;
            const double outside = outside_mm(place);
            if (std::isfinite(outside)) bounds.push_back(outside_bound(place, outside, lattice.step_mm(), belief));
        });
        return bounds;
    }

private:
    static Vec3 foot(const Plane& plane, const Vec3& p) { return p - plane.distance_to(p) * plane.normal; }

    double outside_mm(const Vec3& place) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (const DrawnRegion& region : regions_) {
            const double share = outside_per_mm(normal_, region.section.plane.normal);
            for (const Vec3& shown : region.places.all()) nearest = std::min(nearest, share * distance(shown, place));
        }
        for (const Contour& contour : planes_.set.contours)
            if (!contour.closed)
                for (const Vec3& p : contour.points) nearest = std::min(nearest, distance(p, place));
        for (const SurfacePoint& p : planes_.set.surface) nearest = std::min(nearest, distance(p.position, place));
        for (const Vec3& p : planes_.set.interior) nearest = std::min(nearest, distance(p, place));
        return nearest;
    }

    const DrawnPlanes& planes_;
    const std::vector<DrawnRegion>& regions_;
    Vec3 normal_, center_, u_, v_;
};

}  // namespace

std::vector<Bound> empty_plane_bounds(const DrawnPlanes& planes, const std::vector<DrawnRegion>& regions,
                                      const Plane& empty) {
    const double belief = 1 - smooth_step(kMarginFraction, kReachedThrough, contradiction(planes, empty).reach);
    if (belief < kLeastBelief) return {};
    return EmptyPlane(planes, regions, empty).bounds(belief);
}

std::vector<std::string> contradicted_empty_planes(const DrawnPlanes& planes) {
    std::vector<std::string> sentences;
    for (std::size_t n = 0; n < planes.set.empty_planes.size(); ++n)
        if (const auto [contour, reach] = contradiction(planes, planes.set.empty_planes[n]); reach > kReachedThrough)
            sentences.push_back(
                fmt::format("plane {} in which nothing is seen is contradicted by contour {}, which {}; "
                            "the contour counts",
                            n + 1, contour + 1, reach == 1 ? "lies in it" : "reaches through it"));
    return sentences;
}

}  // namespace kontur
