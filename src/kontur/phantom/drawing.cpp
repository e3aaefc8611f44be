// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/drawing.h"

#include <algorithm>
#include <numeric>

#include "kontur/extract/isolines.h"

namespace kontur {
namespace {

constexpr double kSectionStep_mm = 0.5;
constexpr double kSmallestSection_mm2 = 10;

ContourSet dense_sections(const Body& body, std::span<const Plane> planes) {
    ContourSet set;
    for (const Plane& plane : planes) {
        const auto lattice = lattice_over(plane, corners(body.bounds()), kSectionStep_mm);
        if (!lattice) continue;
        const auto value = [&](double u, double v) { return body.value(plane.from_uv(u, v)); };
        std::vector<double> values;
        values.reserve(static_cast<std::size_t>(lattice->node_count()));
        for (std::int64_t j = 0; j < lattice->rows; ++j)
            for (std::int64_t i = 0; i < lattice->columns; ++i)
                values.push_back(value(lattice->uv(i, j)[0], lattice->uv(i, j)[1]));
        for (const Isoline& line : isolines(*lattice, values, value)) {
            if (line.area_mm2 < kSmallestSection_mm2) continue;
            Contour& contour = set.contours.emplace_back(Contour{.plane = plane, .points = {}, .hole = line.hole});
            for (const auto& [u, v] : line.points) contour.points.push_back(plane.from_uv(u, v));
        }
    }
    return set;
}

/// Shares of `total` proportional to the weights (largest remainders), exact in sum.
std::vector<std::size_t> shares(std::span<const double> weights, std::size_t total) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<std::size_t> result, order(weights.size());
    std::vector<double> remainder;
    for (const double weight : weights) {
        const double exact = static_cast<double>(total) * weight / sum;
        result.push_back(static_cast<std::size_t>(exact));
        remainder.push_back(exact - std::floor(exact));
    }
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return remainder[a] > remainder[b]; });
    const std::size_t missing = total - std::accumulate(result.begin(), result.end(), std::size_t{0});
    for (std::size_t r = 0; r < missing; ++r) ++result[order[r]];
    return result;
}

/// Outward direction of the body's section by the plane at `p`: steepest descent within the plane, not normalised.
std::array<double, 2> descent_in_plane(const Body& body, const Plane& plane, const Vec3& p) {
    const Vec3 gradient = body.gradient(p);
    return {-dot(gradient, plane.u), -dot(gradient, plane.v)};
}

/// The surface point near `p` in its plane, by Newton steps along the in-plane gradient.
Vec3 project_in_plane(const Body& body, const Plane& plane, const Vec3& p) {
    constexpr double kLongestStep_mm = 0.3;
    auto [u, v] = plane.to_uv(p);
    for (int step = 0; step < 12; ++step) {
        const Vec3 here = plane.from_uv(u, v);
        const double value = body.value(here);
        if (std::abs(value) < 1e-12) break;
        const auto [du, dv] = descent_in_plane(body, plane, here);
        const double slope = std::hypot(du, dv);
        const double length = std::clamp(value / slope, -kLongestStep_mm, kLongestStep_mm);
        u += length * du / slope;
        v += length * dv / slope;
    }
    return plane.from_uv(u, v);
}

/// A closed random wave of rms 1 around a contour of the given length: value at the fraction t of its length.
class Wave {
public:
    Wave(double length_mm, const HandOptions& options, Random& random) {
        first_ = std::max(1, static_cast<int>(length_mm / options.longest_wave_mm));
        const int last = std::max(first_ + 1, static_cast<int>(length_mm / options.shortest_wave_mm));
        double power = 0;
        for (int k = first_; k <= last; ++k) {
            terms_.push_back({random.gaussian(), random.uniform(0, 2 * std::numbers::pi)});
            power += 0.5 * terms_.back().amplitude * terms_.back().amplitude;
        }
        for (Term& term : terms_) term.amplitude /= std::sqrt(power);
    }

    double operator()(double t) const {
        double sum = 0;
        int k = first_;
        for (const Term& term : terms_) sum += term.amplitude * std::cos(2 * std::numbers::pi * k++ * t + term.phase);
        return sum;
    }

private:
    struct Term {
        double amplitude, phase;
    };
    int first_;
    std::vector<Term> terms_;
};

void displace(Contour& contour, const Body& body, const HandOptions& options, Random& random) {
    const Wave wave(line_length(contour.points, true), options, random);
    const Plane& plane = contour.plane;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        const auto [du, dv] = descent_in_plane(body, plane, contour.points[i]);
        const double shift = options.rms_mm * wave(static_cast<double>(i) / static_cast<double>(contour.points.size()));
        auto [u, v] = plane.to_uv(contour.points[i]);
        u += shift * du / std::hypot(du, dv) + options.jitter_mm * random.gaussian();
        v += shift * dv / std::hypot(du, dv) + options.jitter_mm * random.gaussian();
        contour.points[i] = plane.from_uv(u, v);
    }
}

}  // namespace

std::vector<Vec3> resample_closed(std::span<const Vec3> points, std::size_t count) {
    const double spacing = line_length(points, true) / static_cast<double>(count);
    std::vector<Vec3> result;
    double way = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
        const double length = distance(a, b);
        while (result.size() < count) {
            const double target = (static_cast<double>(result.size()) + 0.5) * spacing;
            if (target > way + length) break;
            result.push_back(a + (target - way) / length * (b - a));
        }
        way += length;
    }
    return result;
}

ContourSet draw_sections(const Body& body, std::span<const Plane> planes, std::size_t point_count) {
    ContourSet set = dense_sections(body, planes);
    set.name = body.name();
    std::vector<double> lengths;
    for (const Contour& contour : set.contours) lengths.push_back(line_length(contour.points, true));
    const std::vector<std::size_t> counts = shares(lengths, point_count);
    for (std::size_t c = 0; c < counts.size(); ++c) {
        Contour& contour = set.contours[c];
        contour.points = resample_closed(contour.points, counts[c]);
        for (Vec3& p : contour.points) p = project_in_plane(body, contour.plane, p);
    }
    return set;
}

std::vector<std::vector<Vec3>> surface_normals(const Body& body, const ContourSet& set) {
    std::vector<std::vector<Vec3>> normals;
    for (const Contour& contour : set.contours) {
        auto& of_contour = normals.emplace_back();
        for (const Vec3& p : contour.points) of_contour.push_back(body.outward_normal(p));
    }
    return normals;
}

ContourSet drawn_by_hand(ContourSet contours, const Body& body, const HandOptions& options, Random& random) {
    for (Contour& contour : contours.contours) displace(contour, body, options, random);
    return contours;
}

}  // namespace kontur
