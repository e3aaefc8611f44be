// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/tidy.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "kontur/base/checks.h"
#include "kontur/base/error.h"
#include "kontur/drawing/points_on_edges.h"
#include "kontur/drawing/ring_starts.h"

namespace kontur {
namespace {

/// Whether the path turns back on itself at `tip`.
bool is_spike(const Vec3& before, const Vec3& tip, const Vec3& after, double tolerance) {
    if (dot(tip - before, after - tip) >= 0) return distance(before, tip) == 0;
    return distance_to_segment(after, before, tip) < tolerance || distance_to_segment(before, tip, after) < tolerance;
}

/// The path without spikes, by one pass that looks again at the point before a spike that was taken out.
std::vector<Vec3> without_spikes(const std::vector<Vec3>& path, double tolerance) {
    std::vector<Vec3> rest;
    for (const Vec3& p : path) {
        while (rest.size() > 1 && is_spike(rest[rest.size() - 2], rest.back(), p, tolerance)) rest.pop_back();
        if (rest.empty() || !(rest.back() == p)) rest.push_back(p);
    }
    return rest;
}

/// The same for a closed path, whose seam is looked at afterwards.
std::vector<Vec3> without_spikes_around(const std::vector<Vec3>& ring, double tolerance) {
    std::vector<Vec3> rest = without_spikes(ring, tolerance);
    while (rest.size() > 2) {
        const std::size_t n = rest.size();
        if (rest[n - 1] == rest[0] || is_spike(rest[n - 2], rest[n - 1], rest[0], tolerance)) rest.pop_back();
        else if (is_spike(rest[n - 1], rest[0], rest[1], tolerance)) rest.erase(rest.begin());
        else break;
    }
    return rest;
}

std::vector<Vec3> points_without_spikes(const Contour& contour, double tolerance) {
    return contour.closed ? without_spikes_around(contour.points, tolerance) : without_spikes(contour.points, tolerance);
}

std::size_t least_points(const Contour& contour) { return contour.closed ? 3 : 2; }

/// For each point the tolerance up to which Douglas and Peucker's method keeps it; infinity for those it starts from.
class Significance {
public:
    explicit Significance(const Contour& contour) : points_(contour.points), values_(points_.size(), 0) {
        constexpr double kAlways = std::numeric_limits<double>::infinity();
        const std::size_t n = points_.size();
        values_.front() = kAlways;
        if (!contour.closed) {
            values_.back() = kAlways;
            split(0, n - 1, kAlways);
            return;
        }
        std::size_t far = 0;
        for (std::size_t i = 1; i < n; ++i)
            if (distance(points_[i], points_[0]) > distance(points_[far], points_[0])) far = i;
        values_[far] = kAlways;
        split(0, far, kAlways);
        split(far, n, kAlways);
    }

    const std::vector<double>& values() const { return values_; }

private:
    struct Range {
        std::size_t first, last;
        double bound;
    };

    /// Index n is point 0 again.
    const Vec3& at(std::size_t i) const { return points_[i == points_.size() ? 0 : i]; }

    void split(std::size_t first, std::size_t last, double bound) {
        std::vector<Range> open{{first, last, bound}};
        while (!open.empty()) {
            const Range range = open.back();
            open.pop_back();
            if (range.last - range.first < 2) continue;
            double largest = -1;
            std::size_t where = range.first + 1;
            for (std::size_t i = range.first + 1; i < range.last; ++i) {
                const double off = distance_to_segment(points_[i], at(range.first), at(range.last));
                if (off <= largest) continue;
                largest = off;
                where = i;
            }
            // A point is kept only if the point that split its range is.
            values_[where] = std::min(largest, range.bound);
            open.push_back({range.first, where, values_[where]});
            open.push_back({where, range.last, values_[where]});
        }
    }

    const std::vector<Vec3>& points_;
    std::vector<double> values_;
};

constexpr double kOnEdge = 0.07;  // of the tolerance for spikes: so near to an edge a point says nothing of its own

constexpr std::size_t kVast = 4;  // times as many points as are kept

void thin(Contour& contour, const TidyOptions& options, TidyReport& report) {
    const std::size_t most = std::max<std::size_t>(options.most_points, 4);
    const std::size_t before = contour.points.size();
    if (before <= most) return;
    begin_alike(contour, smallest_ball(contour.points));  // what is kept follows from where one begins
    contour = without_points_on_edges(contour, kOnEdge * options.spike_tolerance_mm);
    if (contour.points.size() <= most) {
        if (before / kVast <= options.most_points) return;
        ++report.thinned_contours;
        report.thinned_points += before - contour.points.size();
        report.thinned_mm = std::max(report.thinned_mm, kOnEdge * options.spike_tolerance_mm);
        return;
    }
    const Significance significance(contour);
    std::vector<double> sorted = significance.values();
    const auto last_kept = sorted.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(sorted.begin(), last_kept, sorted.end(), std::greater<>());
    const double limit = std::max(*last_kept, options.thin_tolerance_mm);

    std::vector<Vec3> rest;
    for (std::size_t i = 0; i < contour.points.size(); ++i) {
        if (significance.values()[i] > limit) rest.push_back(contour.points[i]);
        else report.thinned_mm = std::max(report.thinned_mm, significance.values()[i]);
    }
    ++report.thinned_contours;
    report.thinned_points += before - rest.size();
    contour.points = std::move(rest);
}

void check(const TidyOptions& options) {
    check_not_below_0("the tolerance for spikes", options.spike_tolerance_mm, " mm");
    check_not_below_0("the tolerance for thinning", options.thin_tolerance_mm, " mm");
}

}  // namespace

TidyReport thin_vast(ContourSet& set, const TidyOptions& options) {
    check(options);
    TidyReport report;
    for (Contour& contour : set.contours)
        if (contour.points.size() / kVast > options.most_points) thin(contour, options, report);
    return report;
}

bool is_only_spikes(const Contour& contour, double spike_tolerance_mm) {
    return points_without_spikes(contour, spike_tolerance_mm).size() < least_points(contour);
}

TidyReport tidy(ContourSet& set, const TidyOptions& options) {
    check(options);
    TidyReport report;
    for (std::size_t c = 0; c < set.contours.size(); ++c) {
        Contour& contour = set.contours[c];
        const std::size_t before = contour.points.size();
        contour.points = points_without_spikes(contour, options.spike_tolerance_mm);
        if (contour.points.size() < least_points(contour))
            throw Error(ErrorKind::invalid_input,
                        "contour " + std::to_string(c + 1) + " is nothing but a path back along itself");
        report.spike_points += before - contour.points.size();
        thin(contour, options, report);
    }
    return report;
}

}  // namespace kontur
