// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// A smooth solid of the phantom, in the phantom's frame (mm, LPS): inside where `value` > 0.
class Body {
public:
    Body(std::string name, const Box3& bounds, std::function<double(const Vec3&)> value)
        : name_(std::move(name)), bounds_(bounds), value_(std::move(value)) {}

    const std::string& name() const { return name_; }
    /// A box, a few mm too large, outside of which `value` is never > 0.
    const Box3& bounds() const { return bounds_; }
    /// About the depth in mm below the surface; once continuously differentiable near the zero level.
    double value(const Vec3& p) const { return value_(p); }
    /// By central differences; points inward.
    Vec3 gradient(const Vec3& p) const;
    Vec3 outward_normal(const Vec3& p) const { return -normalized(gradient(p)); }

private:
    std::string name_;
    Box3 bounds_;
    std::function<double(const Vec3&)> value_;
};

/// About 200 x 153 x 173 mm: a right and a left lobe, gallbladder fossa, renal impression and an undulating surface.
Body liver();
/// A lobulated tumour of about 43 mm inside the liver's right lobe.
Body metastasis();
/// The right kidney, bean-shaped, beneath the liver.
Body kidney();
/// A lumbar vertebra with body, arch and processes around the spinal canal: a solid with a hole through it.
Body vertebra();

/// The four above, in this order.
std::vector<Body> phantom_bodies();

}  // namespace kontur
