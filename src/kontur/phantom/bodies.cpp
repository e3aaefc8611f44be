// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/bodies.h"

#include "kontur/phantom/depth.h"

namespace kontur {
namespace {

constexpr Vec3 kLiverCenter{-60, -18, 0};
constexpr Vec3 kMetastasisCenter{-112, -16, 10};
constexpr Vec3 kKidneyCenter{-62, 58, -48};
constexpr Vec3 kVertebraCenter{0, 55, -10};

// The bodies undulate at wavelengths that the cases' contours can resolve: of finer relief even the exact surface normals
// at the contours would not tell a fit what lies between them.
double liver_value(const Vec3& point) {
    const Vec3 p = point - kLiverCenter;
    const double right_lobe = depth::ellipsoid(p - Vec3{-38, 0, 0}, {60, 78, 86});
    const double left_lobe = depth::ellipsoid(p - Vec3{38, -16, 22}, {64, 40.5, 42});
    const double visceral_surface = depth::ellipsoid(p - Vec3{66, 22, -80}, {80, 90, 76});
    const double gallbladder_fossa = depth::ellipsoid(p - Vec3{18, -66, -34}, {30, 34, 40});
    const double renal_impression = depth::ellipsoid(p - Vec3{2, 82, -32}, {36, 34, 66});
    double value = depth::join(right_lobe, left_lobe, 30);
    value = depth::subtract(value, visceral_surface, 30);
    value = depth::subtract(value, gallbladder_fossa, 24);
    value = depth::subtract(value, renal_impression, 24);
    return value - 1.5 * std::sin(0.045 * p.x + 0.7) * std::sin(0.3 - 0.04 * p.y) * std::cos(0.043 * p.z);
}

double metastasis_value(const Vec3& point) {
    const Vec3 p = point - kMetastasisCenter;
    const double core = depth::ellipsoid(p, {21.5, 17.7, 19.8});
    const double lobule = depth::ellipsoid(p - Vec3{10.7, 8.6, 6.4}, {11.8, 11.2, 11.2});
    return depth::join(core, lobule, 5) -
           0.8 * std::sin(0.16 * p.x + 0.7) * std::sin(0.19 * p.y + 0.3) * std::cos(0.17 * p.z);
}

double kidney_value(const Vec3& point) {
    Vec3 p = point - kKidneyCenter;
    p.x -= 0.12 * p.z;  // the upper pole leans towards the spine and backwards
    p.y -= 0.12 * p.z;
    const double bean = depth::ellipsoid(p, {25, 23, 54});
    const double hilum = depth::ellipsoid(p - Vec3{26, -4, 0}, {13, 14, 19});
    return depth::subtract(bean, hilum, 9);
}

/// A cylinder's depth cut to |z| < half_height with rounded rims.
double disc(double cylinder, double z, double half_height) {
    return depth::intersect(cylinder, half_height - std::abs(z), 5);
}

double vertebra_value(const Vec3& point) {
    const Vec3 p = point - kVertebraCenter;
    const Vec3 half{std::abs(p.x), p.y, p.z};  // left and right processes are mirror images
    const double waist = 0.92 + 0.08 * (p.z / 13.5) * (p.z / 13.5);
    const double body = disc(depth::elliptic_cylinder({p.x, p.y, 0}, 23 * waist, 16.5 * waist), p.z, 13.5);
    const double pedicle = depth::ellipsoid(half - Vec3{14, 16, 4}, {4.8, 13, 7.5});
    const double ring = 3.2 - std::abs(depth::elliptic_cylinder(p - Vec3{0, 25, 0}, 14.7, 11.7));
    const double lamina = disc(depth::intersect(ring, p.y - 22, 3), p.z + 2, 10);
    const double facet = depth::ellipsoid(half - Vec3{15.5, 31, 0}, {5, 4.5, 16.5});
    const double transverse_process = depth::ellipsoid(half - Vec3{26, 27, 3}, {13, 4, 5});
    const double spinous_process = depth::ellipsoid(p - Vec3{0, 43, -6}, {4, 14, 9});
    const double canal = depth::elliptic_cylinder(p - Vec3{0, 25, 0}, 11.5, 8.5);
    double value = depth::join(body, pedicle, 4);
    for (const double part : {lamina, facet, transverse_process, spinous_process}) value = depth::join(value, part, 3);
    return depth::subtract(value, canal, 2);
}

Box3 box_around(const Vec3& center, const Vec3& low, const Vec3& high) { return {center + low, center + high}; }

}  // namespace

Vec3 Body::gradient(const Vec3& p) const {
    constexpr double h = 1e-4;
    Vec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 low = p, high = p;
        low[axis] -= h;
        high[axis] += h;
        result[axis] = (value_(high) - value_(low)) / (2 * h);
    }
    return result;
}

Body liver() { return {"liver", box_around(kLiverCenter, {-106, -84, -94}, {110, 84, 94}), liver_value}; }
Body metastasis() { return {"metastasis", box_around(kMetastasisCenter, {-26, -23, -25}, {28, 25, 25}), metastasis_value}; }
Body kidney() { return {"kidney", box_around(kKidneyCenter, {-36, -34, -59}, {36, 34, 59}), kidney_value}; }
Body vertebra() { return {"vertebra", box_around(kVertebraCenter, {-44, -21, -21}, {44, 62, 21}), vertebra_value}; }

std::vector<Body> phantom_bodies() { return {liver(), metastasis(), kidney(), vertebra()}; }

}  // namespace kontur
