// SPDX-License-Identifier: Apache-2.0
#include "kontur/moving/space_time.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/function/screened_kernel.h"
#include "kontur/function/smoothing_of_noise.h"
#include "kontur/solve/small_cholesky.h"

namespace kontur {
namespace {

// As fit's normal constraints (fit.h), of the ball's radius and of their length.
constexpr double kNormalLength = 0.027, kSlopeNoise = 0.21, kLeastSlope = 0.2;
constexpr double kSmoothing = 1e-5;
constexpr std::array kStartSmoothing{1e-2, 3e-3, 0.0};  ///< of the rounds that find the tilts, and of the last solve
constexpr double kGradientStep = 0.01;                  ///< of the radius

}  // namespace

std::vector<PointInTime> thinned(std::vector<PointInTime> points, std::size_t most) {
    const std::size_t step = std::max<std::size_t>(1, (points.size() + most - 1) / most);
    std::size_t kept = 0;
    for (std::size_t n = 0; n < points.size(); n += step) points[kept++] = points[n];
    points.resize(kept);
    return points;
}

std::array<double, 2> TimeAsLength::at(double time) const {
    if (!cycle) return {speed_mm * (time - first) / (2 * span), 0};
    const double angle = 2 * std::numbers::pi * (time - first) / *cycle, radius = speed_mm / (2 * std::numbers::pi);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

SpaceTimeFunction::SpaceTimeFunction(const std::vector<PointInTime>& points, const SpaceTimeOptions& options,
                                     const Work& work)
    : ball_(options.ball), time_(options.time) {
    if (options.mean) mean_ = *options.mean;
    const double length = kNormalLength * ball_.radius;
    std::vector<PointInTime> places = points;
    std::vector<double> smoothing(points.size(), kSmoothing);
    for (std::size_t n = 0; n < points.size(); n += 2)
        for (const double side : {1.0, -1.0}) {
            places.push_back(points[n]);
            places.back().position += side * length * points[n].inplane_normal;
            smoothing.push_back(kSmoothing + smoothing_of_noise(kSlopeNoise * kNormalLength));
        }
    for (std::size_t n = 0; n < places.size(); ++n) {
        blocks_.resize(std::max(blocks_.size(), places[n].contour + 1));
        blocks_[places[n].contour].centers.push_back(n);
        blocks_[places[n].contour].on_line += n < points.size();
    }
    std::vector<double> slopes(points.size(), 1.0);
    for (std::size_t round = 0; round < kStartSmoothing.size(); ++round) {
        work.check();
        std::vector<double> values(points.size(), 0.0), smoother = smoothing;
        for (std::size_t n = 0; n < points.size(); n += 2)
            for (const double side : {1.0, -1.0}) values.push_back(-side * length * slopes[n]);
        for (double& s : smoother) s += kStartSmoothing[round];
        solve(places, values, smoother);
        if (round + 1 == kStartSmoothing.size()) break;
        const double step = kGradientStep * ball_.radius;
        for (std::size_t n = 0; n < points.size(); n += 2) {
            const Vec3& p = points[n].position;
            const std::vector<double> f = this->values({p + Vec3{step, 0, 0}, p - Vec3{step, 0, 0}, p + Vec3{0, step, 0},
                                                        p - Vec3{0, step, 0}, p + Vec3{0, 0, step}, p - Vec3{0, 0, step}},
                                                       points[n].time);
            const Vec3 gradient{f[0] - f[1], f[2] - f[3], f[4] - f[5]};
            const double steepness = norm(gradient);
            if (!(steepness > 0)) continue;
            slopes[n] = std::max(-dot(gradient, points[n].inplane_normal) / steepness, kLeastSlope);
        }
    }
}

SpaceTimeFunction::Center SpaceTimeFunction::to_center(const Vec3& p, double time) const {
    const std::array<double, 2> mm = time_.at(time);
    return {(p - ball_.center) / ball_.radius, {mm[0] / ball_.radius, mm[1] / ball_.radius}};
}

double SpaceTimeFunction::sum_at(const Center& at) const {
    double sum = 0;
    for (std::size_t j = 0; j < centers_.size(); ++j) {
        const Vec3 away = at.position - centers_[j].position;
        const double u = at.time[0] - centers_[j].time[0], v = at.time[1] - centers_[j].time[1];
        sum += weights_[j] * screened_kernel(std::sqrt(dot(away, away) + u * u + v * v));
    }
    return sum;
}

std::vector<double> SpaceTimeFunction::values(const std::vector<Vec3>& points, double time) const {
    std::vector<double> values(points.size(), -ball_.radius);
    if (mean_) mean_->lay_over(points, time, values, {.threads = 1});
    for (std::size_t n = 0; n < points.size(); ++n) values[n] += ball_.radius * sum_at(to_center(points[n], time));
    return values;
}

void SpaceTimeFunction::solve(const std::vector<PointInTime>& places, const std::vector<double>& values,
                              const std::vector<double>& smoothing) {
    centers_.clear();
    weights_.clear();
    std::vector<double> residuals;
    for (std::size_t n = 0; n < places.size(); ++n) {
        const double mean = this->values({places[n].position}, places[n].time).front();  // there are no centres yet
        residuals.push_back((values[n] - mean) / ball_.radius);
    }
    for (const PointInTime& place : places) centers_.push_back(to_center(place.position, place.time));
    const int count = static_cast<int>(centers_.size());
    const auto lead = static_cast<std::size_t>(padded_rows(count));
    std::vector<double>& matrix = factor_;
    matrix.assign(lead * centers_.size(), 0.0);
    for (std::size_t j = 0; j < centers_.size(); ++j)
        for (std::size_t i = j; i < centers_.size(); ++i) {
            const Vec3 away = centers_[i].position - centers_[j].position;
            const double u = centers_[i].time[0] - centers_[j].time[0], v = centers_[i].time[1] - centers_[j].time[1];
            matrix[i + j * lead] =
                screened_kernel(std::sqrt(dot(away, away) + u * u + v * v)) + (i == j ? smoothing[i] : 0.0);
        }
    if (!small_cholesky(matrix.data(), count))
        throw Error(ErrorKind::singular_system, "contours of different moments coincide, so that their system is singular");
    residuals.resize(lead, 0.0);
    small_cholesky_solve(matrix.data(), count, residuals.data());
    weights_.assign(residuals.begin(), residuals.begin() + count);
}

double SpaceTimeFunction::square_of_left_out(const Block& block) const {
    const int count = static_cast<int>(centers_.size()), own = static_cast<int>(block.centers.size());
    const std::size_t n = centers_.size(), m = block.centers.size();
    // The rows of the factor's inverse times its transpose are those of the matrix' inverse.
    std::vector<double> columns(n * m);
    for (std::size_t begin = 0; begin < m; begin += kForwardSides) {
        std::vector<double> sides(n * kForwardSides, 0.0);
        const std::size_t end = std::min<std::size_t>(m, begin + kForwardSides);
        for (std::size_t b = begin; b < end; ++b) sides[block.centers[b] * kForwardSides + b - begin] = 1;
        small_cholesky_forward(factor_.data(), count, 0, sides.data());
        for (std::size_t b = begin; b < end; ++b)
            for (std::size_t i = 0; i < n; ++i) columns[b * n + i] = sides[i * kForwardSides + b - begin];
    }
    const auto lead = static_cast<std::size_t>(padded_rows(own));
    std::vector<double> inverse(lead * m, 0.0), error(lead, 0.0);
    for (std::size_t a = 0; a < m; ++a) {
        for (std::size_t b = a; b < m; ++b)
            inverse[b + a * lead] = std::inner_product(&columns[a * n], &columns[a * n] + n, &columns[b * n], 0.0);
        error[a] = weights_[block.centers[a]];
    }
    if (!small_cholesky(inverse.data(), own)) return 0;
    small_cholesky_solve(inverse.data(), own, error.data());
    double sum = 0;
    for (std::size_t a = 0; a < block.on_line; ++a) sum += std::pow(ball_.radius * error[a], 2);
    return sum / static_cast<double>(block.on_line);
}

double SpaceTimeFunction::left_out_error_mm(const std::vector<double>& weights) const {
    double sum = 0, all = 0;
    for (std::size_t c = 0; c < blocks_.size(); ++c) {
        if (weights[c] == 0 || blocks_[c].on_line == 0) continue;
        sum += weights[c] * square_of_left_out(blocks_[c]);
        all += weights[c];
    }
    return all > 0 ? std::sqrt(sum / all) : 0;
}

}  // namespace kontur
