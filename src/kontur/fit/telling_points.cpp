// SPDX-License-Identifier: Apache-2.0
#include "kontur/fit/telling_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kontur/fit/spread.h"
#include "kontur/fit/stretches.h"

namespace kontur {
namespace {

// Between two points that are taken, so that about every fourth is. Three save a tenth more, and double what masks change
// by; one takes half of the points.
constexpr std::size_t kBetween = 2;
constexpr std::size_t kCubic = 4;  // points through which a cubic is laid

/// A line with places along it, and of a ring how long it is.
struct PlacedLine {
    std::vector<const BoundaryPoint*> points;
    std::vector<double> along_mm;
    bool is_ring;
    double length_mm = 0;

    PlacedLine(const std::vector<BoundaryPoint>& all, const Stretch& stretch) : is_ring(stretch.is_ring) {
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            if (!points.empty()) length_mm += distance(points.back()->position, all[i].position);
            points.push_back(&all[i]);
            along_mm.push_back(length_mm);
        }
        if (is_ring) length_mm += distance(points.back()->position, points.front()->position);
    }

    std::size_t size() const { return points.size(); }
    LinePoints positions() const {
        LinePoints line{{}, is_ring};
        for (const BoundaryPoint* p : points) line.positions.push_back(p->position);
        return line;
    }
};

/// Four points of a line about those between the middle two; places on a ring go on past its first point.
struct Cubic {
    std::array<Vec3, kCubic> at;
    std::array<double, kCubic> along_mm;

    Vec3 operator()(double along) const {
        Vec3 sum{};
        for (std::size_t a = 0; a < kCubic; ++a) {
            double weight = 1;
            for (std::size_t b = 0; b < kCubic; ++b)
                if (b != a) weight *= (along - along_mm[b]) / (along_mm[a] - along_mm[b]);
            sum += weight * at[a];
        }
        return sum;
    }
};

/// Across the line; any way where its direction is not known.
double off_mm(const BoundaryPoint& point, const Vec3& place) {
    const Vec3 apart = place - point.position;
    return point.inplane_normal == Vec3{} ? norm(apart) : std::abs(dot(apart, point.inplane_normal));
}

/// Adds the points that the cubics through those taken miss.
void take_missed(const PlacedLine& line, double tolerance_mm, std::vector<bool>& is_taken) {
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < line.size(); ++i)
        if (is_taken[i]) taken.push_back(i);
    if (taken.size() < kCubic) {
        is_taken.assign(line.size(), true);
        return;
    }
    const std::size_t gaps = line.is_ring ? taken.size() : taken.size() - 1;
    for (std::size_t gap = 0; gap < gaps; ++gap) {
        // At the ends of an open line the cubic is that of the gap beside.
        const std::size_t first = line.is_ring ? gap + taken.size() - 1 : std::clamp<std::size_t>(gap, 1, gaps - 2) - 1;
        Cubic cubic{};
        for (std::size_t a = 0; a < kCubic; ++a) {
            const std::size_t i = taken[(first + a) % taken.size()];
            cubic.at[a] = line.points[i]->position;
            cubic.along_mm[a] = line.along_mm[i];
        }
        const double begin = line.along_mm[taken[gap]];
        if (line.is_ring) {
            if (cubic.along_mm[0] > begin) cubic.along_mm[0] -= line.length_mm;
            for (std::size_t a = 2; a < kCubic; ++a)
                if (cubic.along_mm[a] <= begin) cubic.along_mm[a] += line.length_mm;
        }
        const std::size_t end = gap + 1 < taken.size() ? taken[gap + 1] : taken.front() + line.size();
        for (std::size_t next = taken[gap] + 1; next < end; ++next) {
            const std::size_t i = next % line.size();
            const BoundaryPoint& point = *line.points[i];
            const double along = line.along_mm[i] + (next < line.size() ? 0 : line.length_mm);
            // Not a number where points lie at the same place.
            if (!(off_mm(point, cubic(along)) <= tolerance_mm * point.extent)) is_taken[i] = true;
        }
    }
}

std::vector<bool> telling_points_of(const PlacedLine& line, double tolerance_mm) {
    std::vector<bool> is_taken = spread_along(line.positions(), std::vector(line.size(), 0.0), kBetween);
    for (std::size_t i = 0; i < line.size(); ++i)
        if (line.points[i]->inplane_normal == Vec3{} || (!line.is_ring && (i == 0 || i + 1 == line.size())))
            is_taken[i] = true;
    take_missed(line, tolerance_mm, is_taken);
    return is_taken;
}

/// Each stands for half of the points on the way to the next one.
void append(const std::vector<bool>& is_taken, const Stretch& stretch, TellingPoints& telling) {
    const std::size_t first = telling.numbers.size();
    double before_first = 0, between = 0;
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
        if (!is_taken[i - stretch.begin]) {
            ++between;
            continue;
        }
        if (telling.numbers.size() == first) before_first = between;
        else telling.weights.back() += between / 2;
        telling.numbers.push_back(i);
        telling.weights.push_back(1 + (telling.numbers.size() == first + 1 ? 0 : between / 2));
        between = 0;
    }
    telling.weights[first] += (before_first + between) / 2;
    telling.weights.back() += (before_first + between) / 2;
}

}  // namespace

TellingPoints telling_points(const std::vector<BoundaryPoint>& points, double tolerance_mm) {
    TellingPoints telling;
    for (const Stretch& stretch : stretches(points)) {
        const PlacedLine line(points, stretch);
        append(telling_points_of(line, tolerance_mm), stretch, telling);
    }
    const double share = static_cast<double>(telling.numbers.size()) / static_cast<double>(points.size());
    for (double& weight : telling.weights) weight *= share;
    return telling;
}

bool tell_the_rest(const TellingPoints& telling, const std::vector<BoundaryPoint>& points, std::span<const double> values,
                   double tolerance_mm) {
    auto next = telling.numbers.begin();
    for (const Stretch& stretch : stretches(points)) {  // each has one that was taken
        const auto first = next;
        next = std::lower_bound(first, telling.numbers.end(), stretch.end);
        const auto last = next - 1;
        auto before = last, behind = first;
        for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
            if (behind != next && i == *behind) before = behind++;
            const auto after = behind != next ? behind : first;
            const double beside = std::max(std::abs(values[*before]), std::abs(values[*after]));
            if (!(std::abs(values[i]) <= beside + tolerance_mm * points[i].extent)) return false;
        }
    }
    return true;
}

}  // namespace kontur
