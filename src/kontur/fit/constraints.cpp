// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/fit/spread.h"
#include "kontur/fit/stretches.h"

namespace kontur {
namespace {

/// Accepts points that keep a distance from all those accepted before. Cells of several times the largest distance, so that
/// most points need a look into their own only.
class SpacingFilter {
public:
    explicit SpacingFilter(double most) : most_(most), cell_(most > 0 ? 8 * most : 1.0) {}

    bool accept(const Vec3& p, double share) {
        const double apart = share * most_;
        const Vec3 reach{apart, apart, apart};
        const Index3 low = cell_at(p - reach), high = cell_at(p + reach);
        for (std::int64_t k = low.k; k <= high.k; ++k)
            for (std::int64_t j = low.j; j <= high.j; ++j)
                for (std::int64_t i = low.i; i <= high.i; ++i)
                    if (repeats_one_of(cells_.find({i, j, k}), p, apart)) return false;
        cells_[cell_at(p)].push_back(p);
        return true;
    }

private:
    struct Hash {
        std::size_t operator()(const Index3& c) const {
            const auto mix = [](std::uint64_t h, std::int64_t v) {
                return (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15u;
            };
            return mix(mix(mix(0x2545F4914F6CDD1Du, c.i) >> 7, c.j) >> 7, c.k);
        }
    };
    using Cells = std::unordered_map<Index3, std::vector<Vec3>, Hash>;

    Index3 cell_at(const Vec3& p) const {
        constexpr double kLast = 9e18;  // all that is farther away shares a cell
        const auto along = [&](double v) {
            return static_cast<std::int64_t>(std::floor(std::clamp(v / cell_, -kLast, kLast)));
        };
        return {along(p.x), along(p.y), along(p.z)};
    }

    bool repeats_one_of(Cells::const_iterator cell, const Vec3& p, double apart) const {
        if (cell == cells_.end()) return false;
        for (const Vec3& q : cell->second)
            if (p == q || distance(p, q) < apart) return true;
        return false;
    }

    double most_, cell_;
    Cells cells_;
};

/// `kind` is "point" or "single point", `index` counts from 0. They are put into words only where one is refused: there are
/// very many, and each solve asks.
void check_finite(bool finite, std::string_view kind, std::size_t index) {
    if (!finite) throw Error(ErrorKind::invalid_input, fmt::format("{} {} is not finite", kind, index + 1));
}

void check_trust(double trust, std::string_view kind, std::size_t index) {
    if (!(trust > 0 && std::isfinite(trust)))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the trust in {} {} is {:g}; it must be finite and above 0", kind, index + 1, trust));
}

void check_extent(double extent, std::string_view kind, std::size_t index) {
    if (!(extent > 0 && extent <= 1))
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the extent of {} {} is {:g}; it must be in (0, 1]", kind, index + 1, extent));
}

void check_points(std::span<const BoundaryPoint> points, std::span<const PointConstraint> single_points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const BoundaryPoint& p = points[i];
        check_finite(is_finite(p.position) && is_finite(p.inplane_normal), "point", i);
        if (!(p.gap_mm > 0))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the gap of point {} is {:g} mm; it must be above 0", i + 1, p.gap_mm));
        if (!(p.depth_mm > 0))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the depth of point {} is {:g} mm; it must be above 0", i + 1, p.depth_mm));
        check_trust(p.trust, "point", i);
        check_extent(p.extent, "point", i);
    }
    for (std::size_t i = 0; i < single_points.size(); ++i) {
        const PointConstraint& p = single_points[i];
        check_finite(is_finite(p.position) && std::isfinite(p.value), "single point", i);
        check_trust(p.trust, "single point", i);
        check_extent(p.extent, "single point", i);
    }
}

/// A point with normal constraints.
struct Station {
    std::size_t point;
    double stands_for = 1;  ///< points that would have normal constraints if they were not so near to each other
};

/// A station stands for the half of the points on the way to the next one, of which every second one would have two.
void append_spread(std::span<const BoundaryPoint> points, const std::vector<std::size_t>& candidates,
                   const PlaceOptions& options, std::vector<Station>& stations) {
    LinePoints line{{}, points[candidates.front()].on_ring};
    std::vector<double> apart_mm;
    for (const std::size_t i : candidates) {
        line.positions.push_back(points[i].position);
        apart_mm.push_back(points[i].extent * options.normal_spacing_mm);
    }
    const std::vector<bool> is_station = spread_along(line, apart_mm, 1);
    const std::size_t first = stations.size();
    double between = 0, before_first = 0;  // points since the last station
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (!is_station[i]) {
            ++between;
            continue;
        }
        if (stations.size() == first) before_first = between;
        else stations.back().stands_for += between / 4;
        stations.push_back({candidates[i], 0.5 + (stations.size() == first ? 0 : between / 4)});
        between = 0;
    }
    const double around = between + before_first;
    stations.back().stands_for += line.is_ring ? around / 4 : between / 2;
    stations[first].stands_for += line.is_ring ? around / 4 : before_first / 2;
}

std::vector<Station> choose_stations(std::span<const BoundaryPoint> points, const std::vector<bool>& is_placed,
                                     const PlaceOptions& options) {
    std::vector<Station> stations;
    for (const Stretch& stretch : stretches(points)) {
        std::vector<std::size_t> candidates;
        for (std::size_t i = stretch.begin; i < stretch.end; ++i)
            if (is_placed[i] && points[i].inplane_normal != Vec3{}) candidates.push_back(i);
        if (options.both_sides && !candidates.empty()) append_spread(points, candidates, options, stations);
        else
            for (const std::size_t i : candidates) stations.push_back({i});
    }
    return stations;
}

/// The points in the order in which they are kept: where lines come close to each other, that of the larger part of a line.
/// The ends of open lines and single points stay. The paper's constraints, on one side, go by the order of drawing.
std::vector<std::size_t> order_of_keeping(std::span<const BoundaryPoint> points, const PlaceOptions& options) {
    std::vector<double> share_mm(points.size(), std::numeric_limits<double>::infinity());
    for (const Stretch& stretch : stretches(points))
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            const bool is_first = i == stretch.begin, is_last = i + 1 == stretch.end;
            if (!stretch.is_ring && (is_first || is_last)) continue;
            const Vec3 &before = points[is_first ? stretch.end - 1 : i - 1].position, &at = points[i].position,
                       &after = points[is_last ? stretch.begin : i + 1].position;
            share_mm[i] = distance(before, at) + distance(at, after);
        }
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (options.both_sides) std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return share_mm[i]; });
    return order;
}

}  // namespace

void check_place_options(const PlaceOptions& options) {
    check_above_0("the normal offset", options.normal_offset_mm, " mm");
    check_not_below_0("the distance between normal constraints", options.normal_spacing_mm, " mm");
    check_not_below_0("the merge distance", options.merge_distance_mm, " mm");
    check_not_below_0("the noise of the slopes", options.slope_noise);
}

void check_slopes(std::span<const double> slopes, std::size_t points) {
    check_same_count("slopes", slopes.size(), "points", points);
    for (std::size_t i = 0; i < slopes.size(); ++i)
        if (!(slopes[i] > 0 && slopes[i] <= 1 + 1e-9))  // a cosine may be rounded up
            throw Error(ErrorKind::invalid_input, fmt::format("slope {} is {:g}; it must be in (0, 1]", i + 1, slopes[i]));
}

PlacedConstraints place_constraints(std::span<const BoundaryPoint> points, std::span<const double> slopes,
                                    std::span<const PointConstraint> single_points, const PlaceOptions& options) {
    check_place_options(options);
    check_slopes(slopes, points.size());
    check_points(points, single_points);
    PlacedConstraints result;
    SpacingFilter filter(options.merge_distance_mm);
    const auto place = [&](const PointConstraint& p) {
        if (!filter.accept(p.position, p.extent)) {
            ++result.merged;
            return false;
        }
        result.constraints.centers.push_back(p.position);
        result.constraints.values.push_back(p.value);
        result.constraints.trust.push_back(p.trust);
        result.constraints.noise_mm.push_back(p.noise_mm);
        result.constraints.extents.push_back(p.extent);
        return true;
    };

    std::vector<bool> is_placed(points.size());
    for (const std::size_t i : order_of_keeping(points, options))
        is_placed[i] =
            place({.position = points[i].position, .value = 0, .trust = points[i].trust, .extent = points[i].extent});
    const auto place_beside = [&](const Station& station, double side, double room_mm) {
        const BoundaryPoint& point = points[station.point];
        const double offset = std::min(point.extent * options.normal_offset_mm, room_mm / 2);
        place({.position = point.position + side * offset * point.inplane_normal,
               .value = -side * offset * slopes[station.point],
               .trust = point.trust,
               .noise_mm = offset * options.slope_noise / std::sqrt(station.stands_for),
               .extent = point.extent});
    };
    for (const Station& station : choose_stations(points, is_placed, options)) {
        place_beside(station, 1, points[station.point].gap_mm);
        if (options.both_sides) place_beside(station, -1, points[station.point].depth_mm);
    }
    for (const PointConstraint& p : single_points) place(p);
    return result;
}

}  // namespace kontur
