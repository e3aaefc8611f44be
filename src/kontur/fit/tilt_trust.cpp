// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/tilt_trust.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kontur/base/point_tree.h"
#include "kontur/fit/stretches.h"

namespace kontur {
namespace {

constexpr double kMostPlaces = 200;  // at which the direction of a line is looked at

/// A line of consecutive points, by the length along it.
class Line {
public:
    explicit Line(std::span<const BoundaryPoint> points) : points_(points), lengths_(points.size() + 1) {
        double longest = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double step = distance(points[i].position, points[(i + 1) % points.size()].position);
            lengths_[i + 1] = lengths_[i] + step;
            if (i + 1 < points.size()) longest = std::max(longest, step);
        }
        closed_ = lengths_.back() - lengths_[points.size() - 1] <= 2 * longest;
        if (!closed_) lengths_.pop_back();
    }

    double length() const { return lengths_.back(); }

    /// Whether there is a chord from `reach` behind to `reach` ahead, shorter than half of the line, where it still runs
    /// along it.
    bool has_chord(double at, double reach) const {
        return 4 * reach <= length() && (closed_ || (at >= reach && at + reach <= length()));
    }

    Vec3 chord(double at, double reach) const { return position(at + reach) - position(at - reach); }

private:
    Vec3 position(double at) const {
        at = std::clamp(at < 0 ? at + length() : at > length() ? at - length() : at, 0.0, length());
        const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, at);
        const auto i = static_cast<std::size_t>(next - lengths_.begin());
        const double step = lengths_[i] - lengths_[i - 1], along = step > 0 ? (at - lengths_[i - 1]) / step : 0;
        return (1 - along) * points_[i - 1].position + along * points_[i % points_.size()].position;
    }

    std::span<const BoundaryPoint> points_;
    std::vector<double> lengths_;  ///< up to each point, then around
    bool closed_ = false;
};

double angle(const Vec3& a, const Vec3& b) {
    const double lengths = norm(a) * norm(b);
    return lengths > 0 ? std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

/// Calls visit(line) for every stretch of at least three points.
template <class Visit>
void for_each_line(const std::vector<BoundaryPoint>& points, const Visit& visit) {
    for (std::size_t first = 0, next = 1; first < points.size(); first = next++) {
        while (next < points.size() && follows(points, next)) ++next;
        if (next - first >= 3) visit(Line(std::span(points).subspan(first, next - first)));
    }
}

/// A point along the line whose share is known.
struct KnownShare {
    double share, away_mm;
};

/// The next one on one side of a point; none up to the end of an open line.
std::optional<KnownShare> next_known(const std::vector<BoundaryPoint>& points, const std::vector<double>& shares,
                                     const Stretch& stretch, std::size_t from, bool ahead) {
    double away_mm = 0;
    for (std::size_t at = from; stretch.is_ring || at != (ahead ? stretch.end - 1 : stretch.begin);) {
        const std::size_t next =
            ahead ? (at + 1 < stretch.end ? at + 1 : stretch.begin) : (at > stretch.begin ? at - 1 : stretch.end - 1);
        away_mm += distance(points[at].position, points[next].position);
        if (shares[next] >= 0) return KnownShare{shares[next], away_mm};
        if (next == from) break;
        at = next;
    }
    return std::nullopt;
}

/// Points that were not looked at, whose share is below 0, get one between those of their neighbours along the line.
std::vector<double> filled_between(const std::vector<BoundaryPoint>& points, const std::vector<double>& shares) {
    std::vector<double> result = shares;
    for (const Stretch& stretch : stretches(points))
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            if (shares[i] >= 0) continue;
            const auto before = next_known(points, shares, stretch, i, false),
                       after = next_known(points, shares, stretch, i, true);
            if (before && after)
                result[i] = std::lerp(before->share, after->share,
                                      before->away_mm / std::max(before->away_mm + after->away_mm, 1e-300));
            else result[i] = before ? before->share : after ? after->share : 1;
        }
    return result;
}

double square(double x) { return x * x; }

double tilt(double slope) { return std::acos(std::min(slope, 1.0)); }

}  // namespace

LineTurns::LineTurns(const std::vector<BoundaryPoint>& points, double scale_mm) : scale_mm_(scale_mm) {
    std::array<double, kChords> sums{}, weights{};
    for_each_line(points, [&](const Line& line) {
        const int places = static_cast<int>(std::clamp(line.length() / scale_mm, 1.0, kMostPlaces));
        const double step = line.length() / places;
        for (int place = 0; place < places; ++place) {
            const double at = place * step;
            if (!line.has_chord(at, scale_mm)) continue;
            const Vec3 direction = line.chord(at, scale_mm);
            for (std::size_t k = 1; k < kChords; ++k) {
                const double reach = scale_mm * std::exp2(0.5 * static_cast<double>(k));
                if (!line.has_chord(at, reach)) break;
                sums[k] += step * square(angle(line.chord(at, reach), direction));
                weights[k] += step;
            }
        }
    });
    for (std::size_t k = 1; k < kChords; ++k) squares_[k] = weights[k] > 0 ? sums[k] / weights[k] : squares_[k - 1];
}

double LineTurns::square_at(double distance_mm) const {
    const double steps = std::clamp(2 * std::log2(distance_mm / scale_mm_), 0.0, kChords - 1.0);
    const auto k = std::min(static_cast<std::size_t>(steps), kChords - 2);
    const double beyond = steps - static_cast<double>(k);
    return (1 - beyond) * squares_[k] + beyond * squares_[k + 1];
}

std::vector<double> believed_slopes(const std::vector<BoundaryPoint>& points, std::span<const std::size_t> numbers,
                                    std::span<const double> slopes, double scale_mm) {
    const LineTurns turns(points, scale_mm);
    std::vector<Vec3> positions;
    for (const std::size_t i : numbers) positions.push_back(points[i].position);
    const PointTree tree(std::move(positions));
    const auto error_at = [&](const BoundaryPoint& point) {
        const auto counted2 = [&](const Vec3& d) {  // at least the squared distance
            const double out_of_plane = dot(d, point.plane_normal);
            return out_of_plane == 0 ? std::numeric_limits<double>::infinity()
                                     : dot(d, d) * square(1 + square(scale_mm / out_of_plane));
        };
        return turns.square_at(std::sqrt(tree.least(point.position, counted2)));
    };
    std::vector<double> shares(points.size(), -1);  // of what is shown; below 0: not looked at
    for (std::size_t first = 0, last = 0; first < numbers.size(); first = last) {
        double sum = 0;
        for (; last < numbers.size() && points[numbers[last]].contour == points[numbers[first]].contour; ++last)
            sum += square(tilt(slopes[numbers[last]]));
        const double variance = sum / static_cast<double>(last - first);
        for (std::size_t k = first; k < last; ++k) {
            const double error = error_at(points[numbers[k]]);
            shares[numbers[k]] = error < variance ? 1 - error / variance : 0.0;
        }
    }
    std::vector<double> result = filled_between(points, shares);
    for (std::size_t i = 0; i < points.size(); ++i) result[i] = std::cos(result[i] * tilt(slopes[i]));
    return result;
}

}  // namespace kontur
