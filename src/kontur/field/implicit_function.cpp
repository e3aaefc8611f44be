// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/implicit_function.h"

#include <algorithm>
#include <array>

#include "kontur/base/checks.h"
#include "kontur/base/smallest_ball.h"

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
    const Ball3 ball = smallest_ball(points);
    return {ball.center, ball.radius > 0 ? ball.radius : 1.0};
}

ImplicitFunction::ImplicitFunction() : data_(std::make_shared<const Data>()) {}

ImplicitFunction::ImplicitFunction(Kernel kernel, const UnitFrame& frame, PointArrays centers, std::vector<double> weights,
                                   std::array<double, 4> polynomial)
    : data_(std::make_shared<const Data>(Data{kernel, frame, std::move(centers), std::move(weights), polynomial})) {
    check_same_count("weights", data_->weights.size(), "centres", data_->centers.size());
    check_above_0("the scale of the function's frame", frame.scale);
}

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

void ImplicitFunction::add_polynomial(const PointArrays& points, std::span<double> values) const {
    const auto& p = data_->polynomial;
    for (std::size_t i = 0; i < points.size(); ++i)
        values[i] += p[0] + p[1] * points.x[i] + p[2] * points.y[i] + p[3] * points.z[i];
}

/// Adds the polynomial's and goes from the frame's unit to mm.
void ImplicitFunction::finish_gradients(std::span<Vec3> gradients) const {
    const Vec3 linear{data_->polynomial[1], data_->polynomial[2], data_->polynomial[3]};
    for (Vec3& gradient : gradients) gradient = (gradient + linear) / data_->frame.scale;
}

void ImplicitFunction::values(std::span<const Vec3> points_mm, std::span<double> out, int threads) const {
    check_same_count("values", out.size(), "points", points_mm.size());
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel(d.kernel, d.centers, d.weights, points, out, threads);
    add_polynomial(points, out);
}

void ImplicitFunction::gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, int threads) const {
    check_same_count("gradients", out.size(), "points", points_mm.size());
    const Data& d = *data_;
    sum_kernel_gradient(d.kernel, d.centers, d.weights, PointArrays(d.frame.to_unit(points_mm)), out, threads);
    finish_gradients(out);
}

void ImplicitFunction::values_and_gradients(std::span<const Vec3> points_mm, std::span<double> values,
                                            std::span<Vec3> gradients, int threads) const {
    check_same_count("values", values.size(), "points", points_mm.size());
    check_same_count("gradients", gradients.size(), "points", points_mm.size());
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel_and_gradient(d.kernel, d.centers, d.weights, points, values, gradients, threads);
    add_polynomial(points, values);
    finish_gradients(gradients);
}

}  // namespace kontur
