// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/part_fits.h"

#include <span>

#include "kontur/shape/sha256.h"

namespace kontur {
namespace {

/// A digest of numbers.
class Digest {
public:
    void add(double number) { sha_.update(std::as_bytes(std::span(&number, 1))); }
    void add(const Vec3& p) {
        for (const double x : {p.x, p.y, p.z}) add(x);
    }
    void add(const Plane& plane) {
        for (const Vec3& p : {plane.origin, plane.normal, plane.u, plane.v}) add(p);
    }
    /// With their number, so that no list can be taken for another one.
    void add(const std::vector<Vec3>& points) {
        add(static_cast<double>(points.size()));
        for (const Vec3& p : points) add(p);
    }
    std::string hex() const { return sha_.hex(); }

private:
    Sha256 sha_;
};

/// Of all that a fit may depend on: all but the name.
std::string digest(const ContourSet& set, double diameter_mm) {
    Digest digest;
    digest.add(diameter_mm);
    for (const Contour& contour : set.contours) {
        digest.add(contour.plane);
        digest.add(contour.points);
        for (const double number : {contour.closed ? 1.0 : 0.0, contour.hole ? 1.0 : 0.0, static_cast<double>(contour.end),
                                    contour.inside ? 1.0 + static_cast<double>(*contour.inside) : 0.0, contour.weight})
            digest.add(number);
    }
    digest.add(set.interior);
    digest.add(set.exterior);
    for (const SurfacePoint& point : set.surface) {
        digest.add(point.position);
        digest.add(point.outward ? std::vector{*point.outward} : std::vector<Vec3>{});
    }
    for (const Plane& plane : set.empty_planes) digest.add(plane);
    for (const std::size_t count : {set.contours.size(), set.surface.size(), set.empty_planes.size()})
        digest.add(static_cast<double>(count));
    return digest.hex();
}

}  // namespace

ImplicitFunction PartFits::of(const ContourSet& part, double diameter_mm, const FitContours& fit) {
    const std::string key = digest(part, diameter_mm);
    {
        const std::lock_guard lock(mutex_);
        if (const auto entry = fits_.find(key); entry != fits_.end()) {
            entry->second.question = question_;
            return entry->second.function;
        }
    }
    ImplicitFunction function = fit(part);  // others need not wait for it
    const std::lock_guard lock(mutex_);
    fits_.insert_or_assign(key, PartFit{function, question_});
    return function;
}

void PartFits::begin_question() {
    const std::lock_guard lock(mutex_);
    ++question_;
    std::erase_if(fits_, [&](const auto& entry) { return entry.second.question < question_ - kQuestions; });
}

std::size_t PartFits::size() const {
    const std::lock_guard lock(mutex_);
    return fits_.size();
}

}  // namespace kontur
