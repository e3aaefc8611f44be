// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/fit.h"

#include <algorithm>

namespace kontur {
namespace {

/// Cosine of the angle between the surface's normal and the contour's plane.
double slope(const BoundaryPoint& point, const Vec3& gradient, double least_slope) {
    const Vec3 outward = -gradient;
    const double inplane = std::max(dot(outward, point.inplane_normal), least_slope * norm(outward));
    const double tilt = dot(outward, point.plane_normal);
    return inplane > 0 ? inplane / std::hypot(inplane, tilt) : 1.0;
}

/// Reads all slopes from the function's gradient; returns the mean change of the tilt in degrees.
double update_slopes(const ImplicitFunction& function, const std::vector<BoundaryPoint>& points, const FitOptions& options,
                     std::vector<double>& slopes) {
    std::vector<Vec3> positions(points.size()), gradients(points.size());
    std::transform(points.begin(), points.end(), positions.begin(), [](const BoundaryPoint& p) { return p.position; });
    function.gradients(positions, gradients, options.solve.threads);
    double change = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double next = slope(points[i], gradients[i], options.least_slope);
        change += std::abs(std::acos(std::min(next, 1.0)) - std::acos(std::min(slopes[i], 1.0)));
        slopes[i] = next;
    }
    return change / static_cast<double>(points.size()) * 180 / M_PI;
}

std::vector<PointConstraint> interior_and_exterior(const ContourSet& set, double offset_mm) {
    std::vector<PointConstraint> points;
    for (const Vec3& p : set.interior) points.push_back({p, offset_mm, ConstraintKind::interior});
    for (const Vec3& p : set.exterior) points.push_back({p, -offset_mm, ConstraintKind::exterior});
    return points;
}

/// The caps and leak probes, and which of them have become constraints.
class ActiveCaps {
public:
    explicit ActiveCaps(const PreparedContours& contours) : caps_(contours.caps) {
        active_.assign(caps_.size(), contours.coplanar);
        caps_.insert(caps_.end(), contours.leak_probes.begin(), contours.leak_probes.end());
        active_.resize(caps_.size(), false);
        for (const Cap& cap : caps_) positions_.push_back(cap.position);
    }

    /// Activates the caps that the function violates; true if there are new ones.
    bool update(const ImplicitFunction& function, int threads) {
        std::vector<double> values(caps_.size());
        function.values(positions_, values, threads);
        const std::size_t before = count();
        for (std::size_t i = 0; i < caps_.size(); ++i) active_[i] = active_[i] || values[i] > caps_[i].most_mm;
        return count() > before;
    }

    void append_to(std::vector<PointConstraint>& points) const {
        for (std::size_t i = 0; i < caps_.size(); ++i)
            if (active_[i]) points.push_back({caps_[i].position, caps_[i].value_mm, ConstraintKind::cap});
    }
    std::size_t count() const { return static_cast<std::size_t>(std::count(active_.begin(), active_.end(), true)); }

private:
    std::vector<Cap> caps_;
    std::vector<Vec3> positions_;
    std::vector<bool> active_;
};

/// One round's share of the whole progress.
Progress part_of(const Progress& whole, int round, int rounds) {
    if (!whole.callback) return whole;
    return {[&whole, round, rounds](std::string_view stage, double done) { whole.callback(stage, (round + done) / rounds); },
            whole.stop};
}

}  // namespace

std::string_view name(Normals normals) noexcept { return normals == Normals::surface ? "surface" : "in-plane"; }

Fit fit(const PreparedContours& contours, const ContourSet& set, const FitOptions& options, const Progress& progress) {
    Fit result;
    result.slopes.assign(contours.points.size(), 1.0);
    ActiveCaps caps(contours);
    const int rounds = options.normals == Normals::surface ? options.rounds : 0;
    double start_smoothing = options.start_smoothing;
    for (int round = 0;; ++round, start_smoothing *= options.smoothing_factor) {
        const bool tilts_known = round >= rounds;
        std::vector<PointConstraint> single_points = interior_and_exterior(set, options.place.normal_offset_mm);
        caps.append_to(single_points);
        const PlacedConstraints placed = place_constraints(contours.points, result.slopes, single_points, options.place);
        SolveOptions solve_options = options.solve;
        if (!tilts_known) {
            solve_options.smoothing = std::max(start_smoothing, options.solve.smoothing);
            solve_options.tolerance_mm *= options.early_tolerance_factor;
        }
        const Solution solution =
            solve(placed.constraints, solve_options, part_of(progress, std::min(round, rounds), rounds + 1));
        result.function = solution.function;
        result.report = solution.report;
        result.iterations += solution.report.iterations;
        result.merged = placed.merged;
        result.constraints = placed.constraints.size();
        ++result.solves;
        const bool more_caps = caps.update(result.function, options.solve.threads);
        if (tilts_known && (!more_caps || round == rounds + options.cap_rounds)) break;
        if (!tilts_known)
            result.tilt_change_degrees = update_slopes(result.function, contours.points, options, result.slopes);
    }
    result.capped = caps.count();
    return result;
}

}  // namespace kontur
