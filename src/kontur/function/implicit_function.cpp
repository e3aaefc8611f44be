// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/implicit_function.h"

#include <algorithm>
#include <array>
#include <limits>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/base/parallel.h"
#include "kontur/base/smallest_ball.h"
#include "kontur/function/kernel_sums.h"

namespace kontur {
namespace {

double farthest_from_origin(const PointArrays& centers) {
    double farthest = 0;
    for (std::size_t j = 0; j < centers.size(); ++j) farthest = std::max(farthest, norm(centers[j]));
    return farthest;
}

// Drawings that contradict themselves make sums of k that are still positive at several radii. What is subtracted beyond all
// centres and a quarter of a radius outside of the unit ball is flat at its begin up to the second derivative.
constexpr double kFallFrom = 1.25, kFall = 16;

}  // namespace

struct ImplicitFunction::Data {
    Kernel kernel = Kernel::triharmonic;
    UnitFrame frame;
    PointArrays centers;
    std::vector<double> weights;
    std::array<double, 4> polynomial{};
    EvenPowers smooth{};  // all but the sums of kernel_value: the polynomial and, of the screened kernel, the even powers
    double near_radius = std::numeric_limits<double>::infinity();  // up to it all centres are within kScreenedReach
    double fall_from = std::numeric_limits<double>::infinity();

    /// Whether kernel_value does not hold for all centres, so that the screened kernel itself has to be summed.
    bool is_far(const Vec3& point) const { return norm(point) > near_radius; }  // NaN is nowhere, and has the value NaN
    Vec3 far_gradient(const Vec3& at) const;
};

Vec3 ImplicitFunction::Data::far_gradient(const Vec3& at) const {
    Vec3 sum;
    for (std::size_t j = 0; j < centers.size(); ++j) {
        const Vec3 d = at - centers[j];
        sum += weights[j] * screened_kernel_slope(norm(d)) * d;
    }
    return sum;
}

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
                                   const std::array<double, 4>& polynomial) {
    check_same_count("weights", weights.size(), "centres", centers.size());
    check_above_0("the scale of the function's frame", frame.scale);
    const Vec3 linear{polynomial[1], polynomial[2], polynomial[3]};
    EvenPowers smooth{polynomial[0], linear, 0};
    double near = std::numeric_limits<double>::infinity(), fall = near;
    if (kernel == Kernel::screened) {
        if (linear != Vec3{})
            throw Error(ErrorKind::invalid_input,
                        "the screened kernel goes back to a mean; its polynomial's last three numbers must be 0");
        smooth = even_powers(centers, weights);
        smooth.constant += polynomial[0];
        const double farthest = farthest_from_origin(centers);
        near = kScreenedReach - farthest;
        fall = std::max(kFallFrom, farthest);
    }
    data_ = std::make_shared<const Data>(
        Data{kernel, frame, std::move(centers), std::move(weights), polynomial, smooth, near, fall});
}

Kernel ImplicitFunction::kernel() const { return data_->kernel; }
const UnitFrame& ImplicitFunction::frame() const { return data_->frame; }
const PointArrays& ImplicitFunction::centers() const { return data_->centers; }
std::span<const double> ImplicitFunction::weights() const { return data_->weights; }
const std::array<double, 4>& ImplicitFunction::polynomial() const { return data_->polynomial; }

double ImplicitFunction::value(const Vec3& point_mm) const {
    double result = 0;
    values({&point_mm, 1}, {&result, 1}, {.threads = 1});
    return result;
}

Vec3 ImplicitFunction::gradient(const Vec3& point_mm) const {
    Vec3 result;
    gradients({&point_mm, 1}, {&result, 1}, {.threads = 1});
    return result;
}

/// Adds the smooth part to sums of kernel_value; far points get their value by sums of k instead.
void ImplicitFunction::finish_values(const PointArrays& points, std::span<double> values, const Work& work) const {
    const Data& d = *data_;
    std::vector<std::size_t> far;
    std::vector<Vec3> far_points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        values[i] += d.smooth.value(points[i]);
        if (!d.is_far(points[i])) continue;
        far.push_back(i);
        far_points.push_back(points[i]);
    }
    if (far.empty()) return;
    std::vector<double> sums(far.size());
    sum_far_kernel(d.centers, d.weights, PointArrays(far_points), sums, work);
    for (std::size_t k = 0; k < far.size(); ++k) values[far[k]] = d.polynomial[0] + sums[k];
}

/// The same for gradients, and goes from the frame's unit to mm.
void ImplicitFunction::finish_gradients(const PointArrays& points, std::span<Vec3> gradients, const Work& work) const {
    constexpr std::int64_t kPointsPerChunk = 64;  // far ones take as long as all centres
    const Data& d = *data_;
    parallel_for(std::ssize(gradients), kPointsPerChunk, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const Vec3 at = points[i];
            const Vec3 gradient = d.is_far(at) ? d.far_gradient(at) : gradients[i] + d.smooth.gradient(at);
            gradients[i] = (gradient + fall_gradient_at(at)) / d.frame.scale;
        }
    });
}

void ImplicitFunction::add_fall(const PointArrays& points, std::span<double> sums) const {
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (const double beyond = norm(points[i]) - data_->fall_from; beyond > 0)
            sums[i] -= kFall * data_->frame.scale * beyond * beyond * beyond;
}

Vec3 ImplicitFunction::fall_gradient_at(const Vec3& point) const {
    const double beyond = norm(point) - data_->fall_from;
    return beyond > 0 ? -3 * kFall * data_->frame.scale * beyond * beyond * normalized(point) : Vec3{};
}

void ImplicitFunction::sums_at(const PointArrays& points, std::span<double> out, const Work& work) const {
    sum_kernel({data_->kernel, data_->centers, data_->weights}, points, out, work);
    finish_values(points, out, work);
}

void ImplicitFunction::values(std::span<const Vec3> points_mm, std::span<double> out, const Work& work) const {
    check_same_count("values", out.size(), "points", points_mm.size());
    const PointArrays points(data_->frame.to_unit(points_mm));
    sums_at(points, out, work);
    add_fall(points, out);
}

void ImplicitFunction::gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, const Work& work) const {
    check_same_count("gradients", out.size(), "points", points_mm.size());
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel_gradient({d.kernel, d.centers, d.weights}, points, out, work);
    finish_gradients(points, out, work);
}

void ImplicitFunction::values_and_gradients(std::span<const Vec3> points_mm, std::span<double> values,
                                            std::span<Vec3> gradients, const Work& work) const {
    check_same_count("values", values.size(), "points", points_mm.size());
    check_same_count("gradients", gradients.size(), "points", points_mm.size());
    const Data& d = *data_;
    const PointArrays points(d.frame.to_unit(points_mm));
    sum_kernel_and_gradient({d.kernel, d.centers, d.weights}, points, values, gradients, work);
    finish_values(points, values, work);
    add_fall(points, values);
    finish_gradients(points, gradients, work);
}

}  // namespace kontur
