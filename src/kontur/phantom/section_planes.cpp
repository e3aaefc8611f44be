// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/section_planes.h"

#include <cmath>
#include <numbers>

namespace kontur {
namespace {

/// Planes across an axis of the box: the first and last leave `end_share` of its length outside, the others lie evenly
/// between.
std::vector<Plane> planes_across(const Box3& box, int axis, int count, double end_share) {
    std::vector<Plane> planes;
    Vec3 normal{};
    normal[axis] = 1;
    for (int i = 0; i < count; ++i) {
        Vec3 origin = box.center();
        origin[axis] = box.min[axis] + box.size()[axis] * std::lerp(end_share, 1 - end_share, i / (count - 1.0));
        planes.push_back(make_plane(origin, normal));
    }
    return planes;
}

}  // namespace

Box3 extent(const Body& body) {
    constexpr int kSteps = 100;
    Box3 box;
    const Vec3 low = body.bounds().min, step = body.bounds().size() / kSteps;
    for (int k = 0; k <= kSteps; ++k)
        for (int j = 0; j <= kSteps; ++j)
            for (int i = 0; i <= kSteps; ++i)
                if (const Vec3 p = low + Vec3{i * step.x, j * step.y, k * step.z}; body.value(p) > 0) box.extend(p);
    return box;
}

std::vector<Plane> parallel_planes(const Box3& box, int count) { return planes_across(box, 2, count, 0.9 / (count + 0.8)); }

std::vector<Plane> orthogonal_planes(const Box3& box, int sagittal, int coronal, int axial) {
    constexpr double kEndShare = 0.14;
    std::vector<Plane> planes = planes_across(box, 0, sagittal, kEndShare);
    for (const auto& more : {planes_across(box, 1, coronal, kEndShare), planes_across(box, 2, axial, kEndShare)})
        planes.insert(planes.end(), more.begin(), more.end());
    return planes;
}

std::vector<Plane> oblique_planes(const Box3& box, int count, Random& random) {
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        const Vec3 normal{random.gaussian(), random.gaussian(), random.gaussian()};
        const Vec3 share{random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25)};
        const Vec3 size = box.size();
        planes.push_back(make_plane(box.center() + Vec3{share.x * size.x, share.y * size.y, share.z * size.z}, normal));
    }
    return planes;
}

std::vector<Plane> radial_planes(const Box3& box, int count) {
    std::vector<Plane> planes;
    for (int i = 0; i < count; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / count;
        planes.push_back(make_plane(box.center(), {std::cos(angle), std::sin(angle), 0}));
    }
    return planes;
}

}  // namespace kontur
