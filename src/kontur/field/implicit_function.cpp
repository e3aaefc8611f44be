// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/implicit_function.h"

#include <algorithm>
#include <array>

namespace kontur {

struct ImplicitFunction::Data {
    Kernel kernel = Kernel::triharmonic;
    UnitFrame frame;
    PointArrays centers;
    std::vector<double> weights;
    std::array<double, 4> polynomial{};
};

std::vector<Vec3> UnitFrame::to_unit(std::span<const Vec3> points) const {
    std::vector<Vec3> result;
    result.reserve(points.size());
    for (const Vec3& p : points) result.push_back(to_unit(p));
    return result;
}

UnitFrame unit_frame(std::span<const Vec3> points) {
    const Box3 box = bounding_box(points);
    if (box.is_empty()) return {};
    const Vec3 size = box.size();
    const double longest = std::max({size.x, size.y, size.z});
    return {box.center(), longest > 0 ? longest / 2 : 1.0};
}

ImplicitFunction::ImplicitFunction() : data_(std::make_shared<const Data>()) {}

ImplicitFunction::ImplicitFunction(Kernel kernel, const UnitFrame& frame, PointArrays centers, std::vector<double> weights,
                                   std::array<double, 4> polynomial)
    : data_(std::make_shared<const Data>(Data{kernel, frame, std::move(centers), std::move(weights), polynomial})) {}

Kernel ImplicitFunction::kernel() const { return data_->kernel; }
const UnitFrame& ImplicitFunction::frame() const { return data_->frame; }
const PointArrays& ImplicitFunction::centers() const { return data_->centers; }
std::span<const double> ImplicitFunction::weights() const { return data_->weights; }
const std::array<double, 4>& ImplicitFunction::polynomial() const { return data_->polynomial; }

double ImplicitFunction::value(const Vec3& point_mm) const {
    double result = 0;
    values({&point_mm, 1}, {&result, 1}, 1);
    return result;
}

Vec3 ImplicitFunction::gradient(const Vec3& point_mm) const {
    Vec3 result;
    gradients({&point_mm, 1}, {&result, 1}, 1);
    return result;
}

void ImplicitFunction::values(std::span<const Vec3> points_mm, std::span<double> out, int threads) const {
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel(d.kernel, d.centers, d.weights, points, out, threads);
    const auto& p = d.polynomial;
    for (std::size_t i = 0; i < points.size(); ++i)
        out[i] += p[0] + p[1] * points.x[i] + p[2] * points.y[i] + p[3] * points.z[i];
}

void ImplicitFunction::gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, int threads) const {
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel_gradient(d.kernel, d.centers, d.weights, points, out, threads);
    const Vec3 linear{d.polynomial[1], d.polynomial[2], d.polynomial[3]};
    for (Vec3& gradient : out) gradient = (gradient + linear) / d.frame.scale;
}

}  // namespace kontur
