// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/held_out_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kontur/sampling/quantile.h"

namespace kontur {
namespace {

constexpr Rise kSureGain{0, 1};  // standard errors of the mean gain
// Standard errors of the share that is true. Up to 1.5 loses .002 on 48 drawings, .0001 on 32; a step gains .0002 and 0.
constexpr Rise kSureShare{1, 1.15};
constexpr double kLeastImage = 0.25;  // voxels: no image is better known than this
constexpr Rise kSeen{kLeastImage, 2 * kLeastImage};

}  // namespace

void OffsetTruth::add(double error_mm, double moved_mm, double weight) {
    products += weight * moved_mm * error_mm;
    squares += weight * moved_mm * moved_mm;
}

bool tell_enough(std::span<const PlaneErrors> planes) {
    std::size_t points = 0, with_points = 0;
    for (const PlaneErrors& plane : planes) {
        points += plane.points.size();
        with_points += !plane.points.empty();
    }
    return points >= kLeastPoints && with_points >= 2;
}

HeldOutErrors::HeldOutErrors(std::span<const PlaneErrors> planes, const Beliefs& beliefs, double limit_mm, double voxel_mm)
    : beliefs_(beliefs), limit_mm_(limit_mm), voxel_mm_(voxel_mm) {
    for (const PlaneErrors& plane : planes) {
        held_out_.insert(held_out_.end(), plane.points.begin(), plane.points.end());
        planes_ += !plane.points.empty();
        intensities_ += plane.intensities;
    }
    const double share = 1 / static_cast<double>(held_out_.size());
    std::vector<double> without, distances;
    for (const HeldOutPoint& h : held_out_) {
        without.push_back(std::abs(clamped(h.without_mm)));
        distances.push_back(h.distance_mm);
        without_mm_ += share * without.back();
        with_mm_ += share * std::abs(clamped(h.with_mm));
        add(h, share, truth_);
    }
    median_without_ = median(std::move(without));
    median_distance_ = median(std::move(distances));
    error_of_share_ = error_of_share();
}

double HeldOutErrors::clamped(double error_mm) const { return std::clamp(error_mm, -limit_mm_, limit_mm_); }

/// Errors count by the deviation that is expected so far from the contours: where larger ones are, each tells less.
void HeldOutErrors::add(const HeldOutPoint& point, double weight, OffsetTruth& sums) const {
    const double deviation = std::max(beliefs_.prior_mm(point.distance_mm), kLeastPrior * voxel_mm_);
    sums.add(clamped(point.reachable_mm), point.moved_mm(), weight / (deviation * deviation));
}

double HeldOutErrors::weight(const Rise& enough) const {
    return kSureShare.at(in_errors(truth_.share(), error_of_share_)) * enough.at(error_reduction()) * weight_of_planes();
}

double HeldOutErrors::visibility(double edge_mm) const { return kSeen.at(without_mm_ / edge_mm); }

double HeldOutErrors::weight_of_planes() const {
    struct Sum {
        double points = 0, gain_mm = 0;
        double mean() const { return gain_mm / points; }
    };
    std::map<std::size_t, Sum> planes;
    for (const HeldOutPoint& h : held_out_) {
        planes[h.plane].points += 1;
        planes[h.plane].gain_mm += std::abs(clamped(h.without_mm)) - std::abs(clamped(h.with_mm));
    }
    const auto count = static_cast<double>(planes.size());
    double mean = 0, squares = 0;
    for (const auto& [plane, sum] : planes) mean += sum.mean() / count;
    for (const auto& [plane, sum] : planes) squares += std::pow(sum.mean() - mean, 2);
    return count < 2 ? 1 : kSureGain.at(in_errors(mean, std::sqrt(squares / (count - 1) / count)));
}

/// By the jackknife over the planes, since the points of a plane err together.
double HeldOutErrors::error_of_share() const {
    OffsetTruth all;
    std::map<std::size_t, OffsetTruth> planes;
    for (const HeldOutPoint& h : held_out_) {
        add(h, 1, all);
        add(h, 1, planes[h.plane]);
    }
    const auto count = static_cast<double>(planes.size());
    std::vector<double> shares;
    double mean = 0, squares = 0;
    for (const auto& [plane, sums] : planes) {
        shares.push_back(OffsetTruth{all.products - sums.products, all.squares - sums.squares}.share());
        mean += shares.back() / count;
    }
    for (const double share : shares) squares += (share - mean) * (share - mean);
    return std::sqrt(squares * (count - 1) / count);
}

/// The share of what the image tells that is true, less what chance makes of it (the positive part of James and Stein 1961).
double HeldOutErrors::sure_share() const {
    const double share = truth_.share();
    if (share <= error_of_share_) return 0;
    return std::min(share - error_of_share_ * error_of_share_ / share, 1.0);
}

Beliefs HeldOutErrors::beliefs(double weight) const {
    // Of errors u and what an image that is off by e of its own tells, u + e, the share u^2 / (u^2 + e^2) is true.
    const double share = weight * sure_share();
    if (share == 0) return {beliefs_.prior_mm, [](double) { return std::numeric_limits<double>::infinity(); }};
    const double error_mm = kDeviationOfMedian * median_without_ * std::sqrt((1 - share) / share);
    // Held-out contours are about twice as far from others as what lies between all of them. Of what lies farther than they
    // did, less is known.
    return {beliefs_.prior_mm, [=, usual_mm = median_distance_, least_mm = kLeastImage * voxel_mm_](double distance_mm) {
                return std::max(std::max(distance_mm / usual_mm, 0.1) * error_mm, least_mm);
            }};
}

}  // namespace kontur
