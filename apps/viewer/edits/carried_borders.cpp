// SPDX-License-Identifier: Apache-2.0
#include "viewer/edits/carried_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/edits/contour_edits.h"

namespace kontur::viewer {
namespace {

constexpr double kSame = 0.15;  // mm: redrawn stretches are thinned by up to 0.1
constexpr std::size_t kStays = std::numeric_limits<std::size_t>::max();

struct BorderPoint {
    std::size_t edge = 0;  ///< from this point of a closed line to the next
    double along = 0;      ///< from 0 to 1
    Vec3 at;
    double distance = std::numeric_limits<double>::infinity();
};

BorderPoint nearest_on(const std::vector<Vec3>& line, bool is_closed, const Vec3& p) {
    BorderPoint best;
    const std::size_t edges = is_closed ? line.size() : line.size() - 1;
    for (std::size_t n = 0; n < edges; ++n) {
        const Vec3 &a = line[n], along = line[(n + 1) % line.size()] - a;
        const double square = dot(along, along);
        const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
        const Vec3 at = a + t * along;
        if (const double away = distance(p, at); away < best.distance) best = {n, t, at, away};
    }
    return best;
}

double length_of(const std::vector<Vec3>& line) {
    double length = 0;
    for (std::size_t n = 1; n < line.size(); ++n) length += distance(line[n - 1], line[n]);
    return length;
}

Vec3 place_at(const std::vector<Vec3>& line, double length) {
    for (std::size_t n = 1; n < line.size(); ++n) {
        const double step = distance(line[n - 1], line[n]);
        if (length <= step && step > 0) return line[n - 1] + (length / step) * (line[n] - line[n - 1]);
        length -= step;
    }
    return line.back();
}

/// With points between those that are far apart: straight parts of what a hand drew have none.
std::vector<Vec3> in_steps(const std::vector<Vec3>& line) {
    constexpr double kStep_mm = 1, kMostSteps = 2000;
    const double length = distance(line.back(), line.front()) + length_of(line);
    const double step_mm = std::max(kStep_mm, length / kMostSteps);
    std::vector<Vec3> fine;
    for (std::size_t n = 0; n < line.size(); ++n) {
        const Vec3 &from = line[n], along = line[(n + 1) % line.size()] - from;
        const double steps = std::max(1.0, std::ceil(norm(along) / step_mm));
        for (double step = 0; step < steps; ++step) fine.push_back(from + (step / steps) * along);
    }
    return fine;
}

/// Twice the area, seen along the plane's normal.
double turning(const DrawnContour& contour) {
    Vec3 sum;
    for (std::size_t n = 0; n < contour.points.size(); ++n)
        sum += cross(contour.points[n], contour.points[(n + 1) % contour.points.size()]);
    return dot(sum, contour.plane.normal);
}

/// Of a closed line from one place of it on to another.
std::vector<Vec3> stretch(const std::vector<Vec3>& line, const BorderPoint& from, const BorderPoint& to) {
    std::vector<Vec3> part{from.at};
    const bool wraps = to.edge < from.edge || (to.edge == from.edge && to.along <= from.along);
    const std::size_t count = line.size(), edges = (to.edge + (wraps ? count : 0)) - from.edge;
    for (std::size_t n = 1; n <= edges; ++n) part.push_back(line[(from.edge + n) % count]);
    part.push_back(to.at);
    return part;
}

}  // namespace

LineChange::LineChange(const DrawnContour& before, const DrawnContour& after)
    : before_(in_steps(before.points)), part_of_(before_.size(), kStays) {
    std::vector<Vec3> line = after.points;
    if (turning(before) * turning(after) * dot(before.plane.normal, after.plane.normal) < 0)
        std::reverse(line.begin(), line.end());
    const std::size_t count = before_.size();
    std::vector<BorderPoint> places;
    for (const Vec3& p : before_) places.push_back(nearest_on(line, true, p));
    const auto stays = [&](std::size_t n) { return places[n % count].distance < kSame; };
    std::size_t first = 0;
    while (first < count && !stays(first)) ++first;
    if (first == count) {  // nothing stays
        const BorderPoint start = nearest_on(line, true, before_.front());
        Part whole{before_, stretch(line, start, start)};
        whole.before.push_back(before_.front());
        changed_ = bounding_box(before_);
        parts_.push_back(std::move(whole));
        std::fill(part_of_.begin(), part_of_.end(), 0);
        return;
    }
    for (std::size_t n = first; n < first + count; ++n) {
        if (stays(n + 1)) continue;
        std::size_t last = n + 1;
        while (!stays(last)) ++last;
        Part part{{}, stretch(line, places[n % count], places[last % count])};
        for (std::size_t m = n; m <= last; ++m) part.before.push_back(before_[m % count]);
        for (std::size_t m = n; m < last; ++m) part_of_[m % count] = parts_.size();
        for (const Vec3& p : part.before) changed_.extend(p);
        parts_.push_back(std::move(part));
        n = last - 1;
    }
}

std::optional<Vec3> LineChange::carried(const Vec3& p, double near_mm) const {
    if (!changed_.padded(2 * near_mm).contains(p)) return std::nullopt;
    const BorderPoint place = nearest_on(before_, true, p);
    const double weight = std::clamp(2 - place.distance / near_mm, 0.0, 1.0);
    if (part_of_[place.edge] == kStays || weight == 0) return std::nullopt;
    const Part& part = parts_[part_of_[place.edge]];
    const BorderPoint own = nearest_on(part.before, false, p);
    const std::vector<Vec3> up_to(part.before.begin(), part.before.begin() + static_cast<std::ptrdiff_t>(own.edge) + 1);
    const double share = (length_of(up_to) + distance(up_to.back(), own.at)) / std::max(length_of(part.before), 1e-9);
    return p + weight * (place_at(part.after, share * length_of(part.after)) - own.at);
}

std::optional<DrawnContour> carried_along(const DrawnContour& neighbor, const DrawnContour& before,
                                          const DrawnContour& after, double near_mm, SliceEdges& edges) {
    constexpr double kLeastMove = 1e-3;  // mm
    const LineChange change(before, after);
    return bent(
        neighbor,
        [&](const Vec3& p) {
            const std::optional<Vec3> to = change.carried(p, near_mm);
            return to && distance(p, *to) > kLeastMove ? to : std::nullopt;
        },
        near_mm / 2, edges);
}

}  // namespace kontur::viewer
