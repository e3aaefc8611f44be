// SPDX-License-Identifier: Apache-2.0
#include "kontur/drawing/reduce.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>
#include <string>

#include "kontur/base/error.h"

namespace kontur {
namespace {

double point_weight(const Vec3& before, const Vec3& at, const Vec3& after) {
    const Vec3 a = at - before, b = after - at;
    const double la = norm(a), lb = norm(b);
    if (la == 0 || lb == 0) return 0;  // a repeated point carries no shape
    const double angle_weight = (1 - dot(a, b) / (la * lb)) / 2;
    return angle_weight * la * lb / (la + lb);
}

/// The contour as a doubly linked ring from which points are taken; the two ends of an open contour stay.
class Ring {
public:
    explicit Ring(const Contour& contour) : points_(contour.points), closed_(contour.closed), links_(points_.size()) {
        const std::size_t n = points_.size();
        for (std::size_t i = 0; i < n; ++i) links_[i] = {(i + n - 1) % n, (i + 1) % n, true, 0};
        for (std::size_t i = 0; i < n; ++i) update(i);
    }

    void remove(std::size_t i) {
        Link& link = links_[i];
        link.alive = false;
        links_[link.before].after = link.after;
        links_[link.after].before = link.before;
        update(link.before);
        update(link.after);
    }

    std::size_t before(std::size_t i) const { return links_[i].before; }
    std::size_t after(std::size_t i) const { return links_[i].after; }
    bool alive(std::size_t i) const { return links_[i].alive; }
    double weight(std::size_t i) const { return links_[i].weight; }

private:
    struct Link {
        std::size_t before, after;
        bool alive;
        double weight;
    };

    void update(std::size_t i) {
        const bool is_end = !closed_ && (i == 0 || i == points_.size() - 1);
        links_[i].weight = is_end ? std::numeric_limits<double>::infinity()
                                  : point_weight(points_[links_[i].before], points_[i], points_[links_[i].after]);
    }

    const std::vector<Vec3>& points_;
    bool closed_;
    std::vector<Link> links_;
};

}  // namespace

void check_quality(double quality) {
    if (!(quality > 0 && quality <= 1))
        throw Error(ErrorKind::invalid_input, fmt::format("the reduction quality is {:g}; it must be in (0, 1]", quality));
}

Contour reduce(const Contour& contour, const ReduceOptions& options) {
    check_quality(options.quality);
    if (options.min_points < 2)
        throw Error(ErrorKind::invalid_input,
                    fmt::format("a contour is to be reduced to {} points; at least 2 must stay", options.min_points));
    const std::size_t n = contour.points.size();
    // 0.55 * 100 is a little more than 55 in binary; that must not cost a point.
    const auto target = static_cast<std::size_t>(std::ceil(options.quality * static_cast<double>(n) * (1 - 1e-12)));
    const std::size_t keep = std::max(target, options.min_points);
    if (keep >= n) return contour;

    Ring ring(contour);
    using Candidate = std::pair<double, std::size_t>;  // weight when queued, point: ties go to the earlier point
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    for (std::size_t i = 0; i < n; ++i) queue.emplace(ring.weight(i), i);
    for (std::size_t count = n; count > keep;) {
        const auto [weight, i] = queue.top();
        queue.pop();
        if (!ring.alive(i) || weight != ring.weight(i)) continue;  // outdated
        ring.remove(i);
        --count;
        for (const std::size_t neighbour : {ring.before(i), ring.after(i)}) queue.emplace(ring.weight(neighbour), neighbour);
    }

    Contour result = contour;
    result.points.clear();
    for (std::size_t i = 0; i < n; ++i)
        if (ring.alive(i)) result.points.push_back(contour.points[i]);
    return result;
}

}  // namespace kontur
