// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/nearest_points.h"

#include <algorithm>
#include <limits>

#include "kontur/base/instruction_sets.h"

namespace kontur {
namespace {

constexpr std::int32_t kLeafSize = 32;

/// Squared distances of consecutive points to a box.
KONTUR_EVERY_INSTRUCTION_SET void squared_distances(const PointArrays& points, std::int32_t begin, std::int32_t count,
                                                    const Cluster& box, double* __restrict out) {
    const double *x = points.x.data() + begin, *y = points.y.data() + begin, *z = points.z.data() + begin;
    const double cx = box.center.x, cy = box.center.y, cz = box.center.z, hx = box.half.x, hy = box.half.y, hz = box.half.z;
    for (std::int32_t i = 0; i < count; ++i) {
        const double dx = std::max(std::abs(x[i] - cx) - hx, 0.0), dy = std::max(std::abs(y[i] - cy) - hy, 0.0),
                     dz = std::max(std::abs(z[i] - cz) - hz, 0.0);
        out[i] = dx * dx + dy * dy + dz * dz;
    }
}

/// Squared distance of p to the nearest of the points [begin, begin + count).
KONTUR_EVERY_INSTRUCTION_SET double nearest_squared_distance(const PointArrays& points, std::int32_t begin,
                                                             std::int32_t count, const Vec3& p) {
    const double *x = points.x.data() + begin, *y = points.y.data() + begin, *z = points.z.data() + begin;
    double nearest[8];
    std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<double>::infinity());
    std::int32_t i = 0;
    for (; i + 8 <= count; i += 8)
        for (int l = 0; l < 8; ++l) {
            const double dx = x[i + l] - p.x, dy = y[i + l] - p.y, dz = z[i + l] - p.z;
            const double d = dx * dx + dy * dy + dz * dz;
            nearest[l] = d < nearest[l] ? d : nearest[l];
        }
    for (; i < count; ++i) {
        const double dx = x[i] - p.x, dy = y[i] - p.y, dz = z[i] - p.z;
        nearest[0] = std::min(nearest[0], dx * dx + dy * dy + dz * dz);
    }
    return *std::min_element(std::begin(nearest), std::end(nearest));
}

using Candidate = std::pair<double, std::int32_t>;  // squared distance, point

void keep_nearest(std::vector<Candidate>& candidates, std::size_t count) {
    if (candidates.size() <= count) return;
    std::nth_element(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(count), candidates.end());
    candidates.resize(count);
}

/// Their numbers, ascending.
std::vector<std::int32_t> nearest(std::vector<Candidate> candidates, std::size_t count) {
    keep_nearest(candidates, count);
    std::vector<std::int32_t> result;
    for (const auto& [squared, point] : candidates) result.push_back(point);
    std::sort(result.begin(), result.end());
    return result;
}

}  // namespace

struct EarlierNeighbours::Search {
    const PointArrays& points;
    std::int32_t begin, end;  ///< the group; points from `begin` on do not count
    std::size_t wanted;
    Cluster box{};                                           ///< of the group
    double reach = std::numeric_limits<double>::infinity();  ///< squared; nothing farther is among the wanted
    std::vector<Candidate> candidates{};

    /// To the box first, which is nearer than any member.
    void add(double squared_to_box, std::int32_t point) {
        if (point >= begin || squared_to_box > reach) return;
        const double squared = nearest_squared_distance(points, begin, end - begin, points[static_cast<std::size_t>(point)]);
        if (squared > reach) return;
        candidates.emplace_back(squared, point);
        if (candidates.size() < 2 * wanted) return;
        keep_nearest(candidates, wanted);
        reach = std::max_element(candidates.begin(), candidates.end())->first;
    }
};

EarlierNeighbours::EarlierNeighbours(const PointArrays& points, const Work& work)
    : points_(points), tree_(points, kLeafSize, work) {
    for (const std::int32_t p : tree_.order) {
        clustered_.x.push_back(points.x[static_cast<std::size_t>(p)]);
        clustered_.y.push_back(points.y[static_cast<std::size_t>(p)]);
        clustered_.z.push_back(points.z[static_cast<std::size_t>(p)]);
    }
    earliest_.resize(tree_.clusters.size());
    for (std::size_t c = tree_.clusters.size(); c-- > 0;) {
        const Cluster& cluster = tree_.clusters[c];
        const auto child = static_cast<std::size_t>(cluster.first_child);
        earliest_[c] = cluster.is_leaf()
                           ? *std::min_element(tree_.order.begin() + cluster.begin, tree_.order.begin() + cluster.end)
                           : std::min(earliest_[child], earliest_[child + 1]);
    }
}

void EarlierNeighbours::visit(std::int32_t c, Search& search) const {
    const Cluster& cluster = tree_.clusters[static_cast<std::size_t>(c)];
    if (cluster.is_leaf()) {
        double squared[kLeafSize];
        const std::int32_t count = cluster.size();
        squared_distances(clustered_, cluster.begin, count, search.box, squared);
        for (std::int32_t i = 0; i < count; ++i) search.add(squared[i], tree_.order[cluster.begin + i]);
        return;
    }
    const std::int32_t lower = cluster.first_child;
    const double distance[] = {box_distance(search.box, tree_.clusters[lower]),
                               box_distance(search.box, tree_.clusters[lower + 1])};
    const int nearer = distance[1] < distance[0] ? 1 : 0;
    for (const int child : {nearer, 1 - nearer})
        if (earliest_[lower + child] < search.begin && distance[child] * distance[child] <= search.reach)
            visit(lower + child, search);
}

std::vector<std::int32_t> EarlierNeighbours::of(std::int32_t begin, std::int32_t end, std::int32_t count) const {
    Box3 box;
    for (std::int32_t i = begin; i < end; ++i) box.extend(points_[static_cast<std::size_t>(i)]);
    Search search{points_, begin, end, static_cast<std::size_t>(count)};
    search.box.half = 0.5 * box.size();
    search.box.center = box.min + search.box.half;
    if (begin > 0) visit(0, search);
    return nearest(std::move(search.candidates), search.wanted);
}

std::vector<std::int32_t> nearest_points(const PointArrays& points, const Vec3& place, std::int32_t count,
                                         const std::function<bool(std::size_t)>& is_wanted) {
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 d = points[i] - place;
        if (is_wanted(i)) candidates.emplace_back(dot(d, d), static_cast<std::int32_t>(i));
    }
    return nearest(std::move(candidates), static_cast<std::size_t>(count));
}

}  // namespace kontur
