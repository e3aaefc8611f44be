// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
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

    bool repeats_one_of(Cells::const_iterator found, const Vec3& p, double apart) const {
        if (found == cells_.end()) return false;
        for (const Vec3& q : found->second)
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
    std::size_t stands_for = 1;  ///< itself and those after it that would have normal constraints if they were not so near
};

std::vector<Station> choose_stations(std::span<const BoundaryPoint> points, const std::vector<bool>& kept,
                                     const PlaceOptions& options) {
    std::vector<Station> stations;
    std::size_t with_normal = 0;
    double since_mm = std::numeric_limits<double>::infinity();  // from the line's last station
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (follows(points, i)) since_mm += distance(points[i].position, points[i - 1].position);
        else since_mm = std::numeric_limits<double>::infinity();
        if (!kept[i] || points[i].inplane_normal == Vec3{}) continue;
        if (options.both_sides && with_normal++ % 2 == 1) continue;
        if (since_mm < points[i].extent * options.normal_spacing_mm) {
            ++stations.back().stands_for;
            continue;
        }
        stations.push_back({i});
        since_mm = 0;
    }
    return stations;
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

    std::vector<bool> kept(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        kept[i] = place({.position = points[i].position, .value = 0, .trust = points[i].trust, .extent = points[i].extent});
    const auto place_beside = [&](const Station& station, double side, double room_mm) {
        const BoundaryPoint& point = points[station.point];
        const double offset = std::min(point.extent * options.normal_offset_mm, room_mm / 2);
        place({.position = point.position + side * offset * point.inplane_normal,
               .value = -side * offset * slopes[station.point],
               .trust = point.trust,
               .noise_mm = offset * options.slope_noise / std::sqrt(static_cast<double>(station.stands_for)),
               .extent = point.extent});
    };
    for (const Station& station : choose_stations(points, kept, options)) {
        place_beside(station, 1, points[station.point].gap_mm);
        if (options.both_sides) place_beside(station, -1, points[station.point].depth_mm);
    }
    for (const PointConstraint& p : single_points) place(p);
    return result;
}

}  // namespace kontur
