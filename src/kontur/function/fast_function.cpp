// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/fast_function.h"

#include <algorithm>

#include "kontur/base/checks.h"
#include "kontur/base/pick.h"
#include "kontur/function/evaluation_plan.h"
#include "kontur/function/far_field.h"

namespace kontur {
namespace {

// Points that are compared with the direct sum: so many of the first, then one of every so many.
constexpr std::size_t kFirstChecked = 64, kCheckedEvery = 512;

void check(const FastOptions& options) {
    check_above_0("the tolerance of fast values", options.tolerance_mm, " mm");
    check_above_0("the tolerance of fast gradients", options.gradient_tolerance);
    check_at_least("the number of expected points", options.expected_points, 0);
}

/// Null where direct sums are cheapest.
std::unique_ptr<FarField> build(const ImplicitFunction& function, const EvaluationPlan& plan) {
    std::unique_ptr<PointEvaluator> nodes = std::make_unique<DirectSum>(function);
    std::unique_ptr<FarField> field;
    for (auto spacing = plan.spacings.rbegin(); spacing != plan.spacings.rend(); ++spacing) {
        if (field) nodes = std::move(field);
        field = std::make_unique<FarField>(function, *spacing, std::move(nodes));
    }
    return field;
}

}  // namespace

struct FastFunction::State {
    State(const ImplicitFunction& function, const FastOptions& options) : exact(function), options(options) {
        check(options);
        plan = plan_evaluation(exact, static_cast<double>(options.expected_points));
        field = build(exact, plan);
    }

    ImplicitFunction exact;
    FastOptions options;
    EvaluationPlan plan;
    std::unique_ptr<FarField> field;  ///< null: direct sums
    double error_mm = 0;
    std::int64_t earlier_kernel_values = 0;  ///< for direct sums, checks and fields given up

    std::size_t answered = 0;

    /// Which of the next `count` points to compare, and counts them as answered.
    std::vector<std::size_t> choose_checked(std::size_t count) {
        const std::size_t every = answered == 0 ? std::max<std::size_t>(count / kFirstChecked, 1) : kCheckedEvery;
        std::vector<std::size_t> numbers;
        for (std::size_t i = (every - answered % every) % every; i < count; i += every) numbers.push_back(i);
        answered += count;
        earlier_kernel_values += static_cast<std::int64_t>(numbers.size() * exact.centers().size());
        return numbers;
    }

    bool reaches(const PointArrays& points) const {
        const auto all_within = [limit = field->reach()](const std::vector<double>& v) {
            return std::all_of(v.begin(), v.end(), [&](double c) { return std::abs(c) < limit; });
        };
        return all_within(points.x) && all_within(points.y) && all_within(points.z);
    }

    void count_direct(std::size_t points) {
        earlier_kernel_values += static_cast<std::int64_t>(points * exact.centers().size());
    }

    /// After an error beyond the tolerance: a field whose coarsest lattice is half as coarse, if it still pays for the
    /// points to come, which are no fewer than the `count` of this call.
    void update_field(std::size_t count) {
        earlier_kernel_values += field->kernel_values();
        options.expected_points = std::max(options.expected_points - static_cast<std::int64_t>(answered - count),
                                           static_cast<std::int64_t>(count));
        plan = plan_evaluation(exact, static_cast<double>(options.expected_points), plan.spacings.back() / 2);
        field = build(exact, plan);
        error_mm = 0;
        answered = 0;
    }
};

FastFunction::FastFunction(const ImplicitFunction& function, const FastOptions& options)
    : state_(new State(function, options)) {}
FastFunction::~FastFunction() = default;
FastFunction::FastFunction(FastFunction&&) noexcept = default;

const ImplicitFunction& FastFunction::exact() const { return state_->exact; }
double FastFunction::error_mm() const { return state_->error_mm; }
bool FastFunction::is_direct() const { return !state_->field; }
std::int64_t FastFunction::kernel_values() const {
    return state_->earlier_kernel_values + (state_->field ? state_->field->kernel_values() : 0);
}

void FastFunction::values(std::span<const Vec3> points_mm, std::span<double> out, const Work& work) {
    check_same_count("values", out.size(), "points", points_mm.size());
    State& s = *state_;
    const PointArrays points(s.exact.frame().to_unit(points_mm));
    while (s.field && s.reaches(points)) {
        s.field->values(points, out, work);
        s.exact.add_fall(points, out);
        const std::vector<std::size_t> checked = s.choose_checked(points.size());
        std::vector<double> exact(checked.size());
        s.exact.values(pick(points_mm, checked), exact, work);
        for (std::size_t c = 0; c < checked.size(); ++c)
            s.error_mm = std::max(s.error_mm, std::abs(out[checked[c]] - exact[c]));
        if (s.error_mm <= s.options.tolerance_mm) return;
        s.update_field(points.size());
    }
    DirectSum(s.exact).values(points, out, work);
    s.exact.add_fall(points, out);
    s.count_direct(points.size());
}

void FastFunction::gradients(std::span<const Vec3> points_mm, std::span<Vec3> out, const Work& work) {
    check_same_count("gradients", out.size(), "points", points_mm.size());
    State& s = *state_;
    const PointArrays points(s.exact.frame().to_unit(points_mm));
    while (s.field && s.reaches(points)) {
        s.field->gradients(points, out, work);
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = (out[i] + s.exact.fall_gradient_at(points[i])) / s.exact.frame().scale;
        const std::vector<std::size_t> checked = s.choose_checked(points.size());
        std::vector<Vec3> exact(checked.size());
        s.exact.gradients(pick(points_mm, checked), exact, work);
        double error = 0;
        for (std::size_t c = 0; c < checked.size(); ++c) error = std::max(error, distance(out[checked[c]], exact[c]));
        if (error <= s.options.gradient_tolerance) return;
        s.update_field(points.size());
    }
    work.check();
    s.exact.gradients(points_mm, out, work);
    s.count_direct(points.size());
}

}  // namespace kontur
