// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/reconcile.h"

#include <algorithm>
#include <cmath>

#include "kontur/base/checks.h"

namespace kontur {
namespace {

/// A place about which a contour is not trusted.
struct Doubt {
    Vec3 position, other_position;
    double radius_mm;
    double weight;  ///< added to 1 in the middle
};

/// How much each contour is trusted where it has not yielded to another; 1 without points.
std::vector<double> trust_by_contour(const std::vector<BoundaryPoint>& points) {
    std::vector<double> trust;
    for (const BoundaryPoint& point : points) {
        if (point.contour < 0) continue;
        const auto contour = static_cast<std::size_t>(point.contour);
        if (trust.size() <= contour) trust.resize(contour + 1, 0);
        trust[contour] = std::max(trust[contour], point.trust);
    }
    std::replace(trust.begin(), trust.end(), 0.0, 1.0);
    return trust;
}

std::vector<std::vector<Doubt>> doubts_by_contour(std::span<const Crossing> crossings, const std::vector<double>& trusts,
                                                  double offset_mm, const ReconcileOptions& options) {
    std::vector<std::vector<Doubt>> doubts;
    const auto add = [&](std::size_t contour, const Doubt& doubt) {
        if (doubts.size() <= contour) doubts.resize(contour + 1);
        doubts[contour].push_back(doubt);
    };
    const auto trust = [&](std::size_t contour) { return contour < trusts.size() ? trusts[contour] : 1.0; };
    for (const Crossing& crossing : crossings) {
        if (!crossing.matched || !(crossing.disagreement_mm > 0)) continue;
        const double relative = crossing.disagreement_mm / offset_mm;
        const auto doubt = [&](double share) {
            return Doubt{crossing.position, crossing.other_position, options.reach * crossing.disagreement_mm,
                         share * options.strength * relative * relative};
        };
        const auto [older, newer] = std::minmax({crossing.contour, crossing.other});
        if (options.conflicts == Conflicts::newest_wins) {
            add(older, doubt(1));
            continue;
        }
        const double both = trust(older) + trust(newer);
        add(older, doubt(2 * trust(newer) / both));
        add(newer, doubt(2 * trust(older) / both));
    }
    return doubts;
}

double trust_at(const Vec3& p, const std::vector<Doubt>& doubts) {
    double largest_doubt = 0;
    for (const Doubt& doubt : doubts) {
        const double away = std::min(distance(p, doubt.position), distance(p, doubt.other_position));
        const double inward = std::max(0.0, 1 - away / doubt.radius_mm);
        largest_doubt = std::max(largest_doubt, doubt.weight * std::pow(inward, 4));
    }
    return 1 / (1 + largest_doubt);
}

}  // namespace

std::string_view name(Conflicts conflicts) noexcept {
    switch (conflicts) {
        case Conflicts::reconcile:
            return "reconcile";
        case Conflicts::newest_wins:
            return "newest-wins";
        case Conflicts::exact:
            return "exact";
    }
    return "?";
}

void reconcile(std::vector<BoundaryPoint>& points, std::span<const Crossing> crossings, double diameter_mm,
               const ReconcileOptions& options) {
    const double offset_mm = options.offset_mm.value_or(kMarginFraction * diameter_mm);
    check_above_0("the offset to reconcile by", offset_mm, " mm");
    check_not_below_0("the strength of reconciling", options.strength);
    check_above_0("the reach of reconciling", options.reach);
    if (options.conflicts == Conflicts::exact) return;
    const std::vector<std::vector<Doubt>> doubts =
        doubts_by_contour(crossings, trust_by_contour(points), offset_mm, options);
    for (BoundaryPoint& point : points)
        if (const auto contour = static_cast<std::size_t>(point.contour); contour < doubts.size())
            point.trust *= trust_at(point.position, doubts[contour]);
}

}  // namespace kontur
