// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/work.h"
#include "kontur/function/kernel.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// Coordinates in which the system is set up: x -> (x - center) / scale, so that the centres lie in the unit ball,
/// however they are turned. In raw millimetres the condition number is five orders of magnitude worse, with a patient offset
/// nine.
struct UnitFrame {
    Vec3 center;
    double scale = 1;

    Vec3 to_unit(const Vec3& p) const { return (p - center) / scale; }
    std::vector<Vec3> to_unit(std::span<const Vec3> points) const;
};

/// The frame of a point set: centre and radius of its smallest ball (1 for a single point).
UnitFrame unit_frame(std::span<const Vec3> points);

/// f(x) = p0 + p . x + sum_j w_j phi(|x - c_j|) (paper Eq. 2), positive inside, in mm near the surface. With the screened
/// kernel phi is k of screened_kernel.h and p0 the mean that f goes back to away from all centres; p is 0; and from
/// a = 1.25 in the unit frame or the farthest centre on f falls by another 16 (|x| - a)^3 radii, so that it is negative far
/// away whatever the weights are. Immutable, cheap to copy, safe to read from any thread.
class ImplicitFunction {
public:
    /// The zero function.
    ImplicitFunction();
    /// `centers` in `frame`'s unit coordinates; `polynomial` = {p0, p1, p2, p3} on the same coordinates. Throws
    /// Error(invalid_input) unless there is one weight for each centre, the frame's scale is above 0 and, with the screened
    /// kernel, p is 0.
    ImplicitFunction(Kernel kernel, const UnitFrame& frame, PointArrays centers, std::vector<double> weights,
                     const std::array<double, 4>& polynomial);

    Kernel kernel() const;
    const UnitFrame& frame() const;
    const PointArrays& centers() const;
    std::span<const double> weights() const;
    const std::array<double, 4>& polynomial() const;

    double value(const Vec3& point_mm) const;
    /// Gradient per mm; it points inward.
    Vec3 gradient(const Vec3& point_mm) const;

    /// out[i] = value(points[i]), the same bytes as `value`, in bulk on `threads` threads (0: the machine's). This and the
    /// following throw Error(invalid_input) unless there is one place in `out` for each point.
    void values(std::span<const Vec3> points_mm, std::span<double> out, const Work& work = {}) const;
    /// out[i] = gradient(points[i]), in bulk.
    void gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, const Work& work = {}) const;

    /// Both at once, the same bytes; cheaper than one after the other.
    void values_and_gradients(std::span<const Vec3> points_mm, std::span<double> values, std::span<Vec3> gradients,
                              const Work& work = {}) const;

    /// values() of points in the unit frame, without the fall far away, which interpolation had better not see.
    void sums_at(const PointArrays& points, std::span<double> out, const Work& work) const;
    /// Adds the fall, in mm, to sums at points in the unit frame.
    void add_fall(const PointArrays& points, std::span<double> sums) const;
    /// Its gradient at a point in the unit frame.
    Vec3 fall_gradient_at(const Vec3& point) const;

private:
    struct Data;
    void finish_values(const PointArrays& points, std::span<double> values, const Work& work) const;
    void finish_gradients(const PointArrays& points, std::span<Vec3> gradients, const Work& work) const;

    std::shared_ptr<const Data> data_;
};

}  // namespace kontur
