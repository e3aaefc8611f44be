// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

struct FastOptions {
    double tolerance_mm = 0.01;        ///< largest error of a value accepted at the points that are checked
    double gradient_tolerance = 0.01;  ///< largest error of a gradient (mm per mm) accepted there
    std::int64_t expected_points = 0;  ///< how many will be evaluated; decides what preparation pays
};

/// An implicit function's values and gradients at many points near its centres, faster than by the sums over all centres:
/// near centres are summed directly, the smooth rest is interpolated between lattice nodes (far_field.h). Where that would
/// cost more than it saves (few centres or few points) the values are ImplicitFunction's own. Each call compares some of its
/// values with those; if one misses the tolerance, that call and all later ones are answered through lattices half as coarse
/// or, where these do not pay, by direct sums. Keeps what it
/// computed for later calls; memory grows with the volume that the points fill. Not for use from several threads at once,
/// and not after a call that threw. Same bytes for any number of threads (of one
/// processor type; direct sums: of any).
class FastFunction {
public:
    /// Throws Error(invalid_input) for tolerances that are not finite and above 0 and counts below 0.
    explicit FastFunction(const ImplicitFunction& function, const FastOptions& options = {});
    ~FastFunction();
    FastFunction(FastFunction&&) noexcept;

    const ImplicitFunction& exact() const;

    /// out[i] = f(points[i]) within about error_mm(). Both throw Error(invalid_input) unless there is one place in `out` for
    /// each point.
    void values(std::span<const Vec3> points_mm, std::span<double> out, const Work& work = {});
    /// out[i] = gradient at points[i] per mm.
    void gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, const Work& work = {});

    /// The largest error of a value found so far; 0 while all values are direct sums.
    double error_mm() const;
    /// Whether values are direct sums now.
    bool is_direct() const;
    /// phi evaluated so far, for values and what they needed.
    std::int64_t kernel_values() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace kontur
