// SPDX-License-Identifier: Apache-2.0
#include "kontur/correct/change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kontur/base/error.h"
#include "kontur/base/smooth_step.h"
#include "kontur/function/kernel_sums.h"
#include "kontur/function/screened_kernel.h"
#include "kontur/solve/small_cholesky.h"

namespace kontur {
namespace {

constexpr double kFadeFrom = 0.75;        ///< of the reach
constexpr double kNoChange = 0.2;         ///< of the step: corrections that ask for less repeat the mask
constexpr double kNugget = 1e-6;          ///< of the prior's variance
constexpr double kBoundNoise = 0.1;       ///< of what a bound asks for
constexpr double kBoundStepNoise = 0.05;  ///< of the step
constexpr double kKept = 0.5;             ///< of what a bound asks for: less breaks it. Either of .3 and .7 changes nothing
constexpr double kKeptBefore = 0.8;       ///< the same of f0 alone
constexpr double kApart = 0.35;  ///< of the spacing: nearer data of other planes repeat each other. Half of it costs
                                 ///< .0015 of mean Dice (bench/correct.py, three axial planes), twice .0008
constexpr int kRounds = 6;

/// k of r' = r / unit, where k(0) = 1.
double kernel(double scaled) {
    constexpr double at_zero = 3 * kScreeningLength * kScreeningLength * kScreeningLength;
    return screened_kernel_far(scaled) / at_zero;
}

struct Center {
    Vec3 position;
    double change_mm, noise_mm;
};

}  // namespace

double likeness(double distance_mm, double length_mm) {
    const double x = std::sqrt(3.0) * distance_mm / length_mm;
    return (1 + x) * std::exp(-x);
}

std::vector<double> SurfaceChange::values(std::span<const Vec3> positions, const Work& work) const {
    std::vector<double> values(positions.size());
    if (is_zero()) return values;
    const double unit = length_mm_ / (kScreeningLength * std::sqrt(3.0)), reach = reach_mm();
    std::vector<std::size_t> near;
    std::vector<double> fades;
    std::vector<Vec3> scaled;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const double fade = 1 - smooth_step(kFadeFrom * reach, reach, moved_tree_->distance_to(positions[n]));
        if (fade <= 0) continue;
        near.push_back(n);
        fades.push_back(fade);
        scaled.push_back(positions[n] / unit);
    }
    const PointArrays targets(scaled);
    std::vector<double> added(near.size()), removed(near.size());
    if (removed_.empty()) sum_far_kernel(centers_, added_, targets, added, work);
    else if (added_.empty()) sum_far_kernel(centers_, removed_, targets, removed, work);
    else sum_far_kernel_twice(centers_, {added_, removed_}, targets, {added, removed}, work);
    for (std::size_t n = 0; n < near.size(); ++n)
        values[near[n]] = fades[n] * (std::max(added[n], 0.0) + std::min(removed[n], 0.0));
    return values;
}

double SurfaceChange::distance_to_moved(const Vec3& position) const {
    return moved_tree_ ? moved_tree_->distance_to(position) : std::numeric_limits<double>::infinity();
}

Box3 SurfaceChange::box() const { return moved_.empty() ? Box3{} : bounding_box(std::span(moved_)).padded(reach_mm()); }

/// Data and the bounds that take part, and g through them.
class ChangeSolver {
public:
    ChangeSolver(const ExistingSurface& surface, const CorrectionData& data, const CorrectionLengths& lengths,
                 const Work& work)
        : data_(data), lengths_(lengths), work_(work) {
        for (const CorrectionDatum& datum : data.data)
            if (!repeats(datum))
                add({datum.position, datum.value_mm - surface.value(datum.position), datum.noise_mm}, datum.section);
        for (const CorrectionBound& bound : data.bounds) before_.push_back(surface.value(bound.position));
        takes_part_.resize(data.bounds.size());
    }

    SurfaceChange solve() {
        for (std::size_t n = 0; n < before_.size(); ++n) changes_.push_back(0);
        hold_broken(kKeptBefore);
        double largest = 0;
        for (const Center& center : centers_) largest = std::max(largest, std::abs(center.change_mm));
        if (largest < kNoChange * lengths_.step) return {};

        std::vector<Vec3> places;
        for (const CorrectionBound& bound : data_.bounds) places.push_back(bound.position);
        SurfaceChange change;
        for (int round = 0; round < kRounds; ++round) {
            change = through_centers();
            changes_ = change.values(places, work_);
            if (!hold_broken(kKept)) break;
        }
        return change;
    }

private:
    /// Whether another plane has a datum there already.
    bool repeats(const CorrectionDatum& datum) const {
        for (std::size_t n = 0; n < centers_.size(); ++n)
            if (sections_[n] != datum.section && distance(centers_[n].position, datum.position) < kApart * lengths_.spacing)
                return true;
        return false;
    }

    void add(const Center& center, std::size_t section) {
        if (centers_.size() >= kMostCorrectionCenters)
            throw Error(ErrorKind::too_large, fmt::format("the corrections need more than {} data; correct in several steps",
                                                          kMostCorrectionCenters));
        centers_.push_back(center);
        centers_.back().change_mm *= data_.moved_shares[section];
        sections_.push_back(section);
    }

    /// Lets the bounds take part that are broken most in their surroundings. True if there were any.
    bool hold_broken(double kept) {
        std::vector<std::pair<double, std::size_t>> broken;
        for (std::size_t n = 0; n < before_.size(); ++n) {
            const CorrectionBound& bound = data_.bounds[n];
            const double lacking = kept * bound.least_mm - bound.sign * (before_[n] + changes_[n]);
            if (!takes_part_[n] && lacking > 0) broken.emplace_back(-lacking, n);
        }
        std::sort(broken.begin(), broken.end());
        std::vector<Vec3> limits;
        for (const auto& [lacking, n] : broken) {
            const CorrectionBound& bound = data_.bounds[n];
            const auto is_near = [&](const Vec3& p) { return distance(p, bound.position) < lengths_.spacing; };
            if (std::any_of(limits.begin(), limits.end(), is_near)) continue;
            limits.push_back(bound.position);
            takes_part_[n] = true;
            add({bound.position, bound.sign * bound.least_mm - before_[n],
                 kBoundNoise * bound.least_mm + kBoundStepNoise * lengths_.step},
                bound.section);
        }
        return !limits.empty();
    }

    /// The factored matrix of the centres' equations.
    std::vector<double> factors(const std::vector<Vec3>& scaled) const {
        double squares = 0;
        for (const Center& center : centers_) squares += center.change_mm * center.change_mm;
        const double variance = 2 * squares / static_cast<double>(centers_.size()) + 1e-6;
        const auto n = static_cast<int>(centers_.size());
        const std::ptrdiff_t lead = padded_rows(n);
        std::vector<double> matrix(static_cast<std::size_t>(lead * n));
        for (int j = 0; j < n; ++j) {
            work_.check();
            for (int i = j; i < n; ++i) matrix[j * lead + i] = kernel(distance(scaled[i], scaled[j]));
            matrix[j * lead + j] += centers_[j].noise_mm * centers_[j].noise_mm / variance + kNugget;
        }
        if (!small_cholesky(matrix.data(), n))
            throw Error(ErrorKind::singular_system, "the corrections' equations have no solution: data lie on each other");
        return matrix;
    }

    /// Weights of the process through the changes of one sign, 0 where they have the other; none without such changes.
    std::vector<double> weights(const std::vector<double>& factors, double sign) const {
        std::vector<double> weights(static_cast<std::size_t>(padded_rows(static_cast<int>(centers_.size()))));
        for (std::size_t n = 0; n < centers_.size(); ++n)
            if (sign * centers_[n].change_mm > 0) weights[n] = centers_[n].change_mm;
        if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) return {};
        small_cholesky_solve(factors.data(), static_cast<int>(centers_.size()), weights.data());
        weights.resize(centers_.size());
        for (double& weight : weights) weight *= kernel(0) / screened_kernel_far(0);
        return weights;
    }

    SurfaceChange through_centers() const {
        const double unit = lengths_.length / (kScreeningLength * std::sqrt(3.0));
        std::vector<Vec3> scaled;
        for (const Center& center : centers_) scaled.push_back(center.position / unit);
        const std::vector<double> factored = factors(scaled);

        SurfaceChange change;
        change.centers_ = PointArrays(scaled);
        change.added_ = weights(factored, 1);
        change.removed_ = weights(factored, -1);
        change.length_mm_ = lengths_.length;
        for (const Center& center : centers_) {
            change.largest_mm_ = std::max(change.largest_mm_, std::abs(center.change_mm));
            if (std::abs(center.change_mm) <= kNoChange * lengths_.step) continue;
            change.moved_.push_back(center.position);
            change.mean_mm_ += std::abs(center.change_mm);
        }
        if (!change.moved_.empty()) change.mean_mm_ /= static_cast<double>(change.moved_.size());
        change.moved_tree_.emplace(change.moved_);
        return change;
    }

    const CorrectionData& data_;
    const CorrectionLengths& lengths_;
    const Work& work_;
    std::vector<Center> centers_;
    std::vector<std::size_t> sections_;  ///< of the centres
    std::vector<double> before_;         ///< f0 at the bounds
    std::vector<double> changes_;        ///< g there
    std::vector<bool> takes_part_;
};

SurfaceChange solve_change(const ExistingSurface& surface, const CorrectionData& data, const CorrectionLengths& lengths,
                           const Work& work) {
    return ChangeSolver(surface, data, lengths, work).solve();
}

}  // namespace kontur
