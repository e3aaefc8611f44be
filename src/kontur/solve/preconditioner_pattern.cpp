// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kontur/base/parallel.h"
#include "kontur/solve/nearest_points.h"
#include "kontur/solve/preconditioner.h"

namespace kontur {
namespace {

/// More points need more neighbours to be solved in as many iterations.
int fitting_neighbours(std::size_t points) {
    return points <= 1200 ? 64 : points <= 3000 ? 96 : points <= 20000 ? 128 : points <= 400000 ? 192 : 256;
}

/// Its factorisation takes no longer than the others' together.
int fitting_top(std::size_t points) { return points <= 20000 ? 400 : 800; }

PointArrays reordered(const PointArrays& points, const std::vector<std::int32_t>& order) {
    PointArrays result;
    for (const std::int32_t i : order) {
        result.x.push_back(points.x[static_cast<std::size_t>(i)]);
        result.y.push_back(points.y[static_cast<std::size_t>(i)]);
        result.z.push_back(points.z[static_cast<std::size_t>(i)]);
    }
    return result;
}

}  // namespace

PreconditionerPattern::PreconditionerPattern(const PointArrays& points, const PreconditionerOptions& options,
                                             const Work& work)
    : options_(options) {
    if (options_.neighbours <= 0) options_.neighbours = fitting_neighbours(points.size());
    if (options_.dense_top <= 0) options_.dense_top = fitting_top(points.size());
    const MultiscaleOrder order = multiscale_order(points);
    work.check();
    order_ = order.order;
    points_ = reordered(points, order_);
    top_ = std::min(static_cast<std::int32_t>(order_.size()), options_.dense_top);
    cut_into_supernodes(order);
    find_neighbours(work);
    index_occurrences();
}

PreconditionerPattern::PreconditionerPattern(const PreconditionerPattern& earlier, const PointArrays& points)
    : PreconditionerPattern(earlier) {
    for (std::size_t i = order_.size(); i < points.size(); ++i) {
        const auto point = static_cast<std::int32_t>(i);
        const std::vector<std::int32_t> neighbours =
            nearest_points(points_, points[i], options_.neighbours, [](std::size_t) { return true; });
        supernodes_.push_back({point, 1, static_cast<std::int32_t>(neighbours.size()), columns_.size()});
        columns_.insert(columns_.end(), neighbours.begin(), neighbours.end());
        columns_.push_back(point);
        order_.push_back(point);
        points_.x.push_back(points.x[i]);
        points_.y.push_back(points.y[i]);
        points_.z.push_back(points.z[i]);
    }
    index_occurrences();
}

void PreconditionerPattern::cut_into_supernodes(const MultiscaleOrder& order) {
    for (std::size_t level = 0; level + 1 < order.level_begin.size(); ++level) {
        const std::int32_t level_end = order.level_begin[level + 1];
        const double widest = 12 * order.spacing[level];  // members farther apart would share too few neighbours
        for (std::int32_t begin = std::max(order.level_begin[level], top_); begin < level_end;) {
            Box3 box;
            std::int32_t end = begin;
            while (end < level_end && end - begin < options_.supernode) {
                Box3 grown = box;
                grown.extend(points_[static_cast<std::size_t>(end)]);
                const Vec3 size = grown.size();
                if (end > begin && largest(size) > widest) break;
                box = grown;
                ++end;
            }
            supernodes_.push_back({begin, end - begin, 0, 0});
            begin = end;
        }
    }
}

void PreconditionerPattern::find_neighbours(const Work& work) {
    const EarlierNeighbours neighbours(points_, work);
    std::vector<std::vector<std::int32_t>> rows(supernodes_.size());
    parallel_for(static_cast<std::int64_t>(supernodes_.size()), 16, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto s = static_cast<std::size_t>(begin); s < static_cast<std::size_t>(end); ++s)
            rows[s] =
                neighbours.of(supernodes_[s].begin, supernodes_[s].begin + supernodes_[s].members, options_.neighbours);
    });
    for (std::size_t s = 0; s < supernodes_.size(); ++s) {
        Supernode& node = supernodes_[s];
        node.neighbours = static_cast<std::int32_t>(rows[s].size());
        node.columns = columns_.size();
        columns_.insert(columns_.end(), rows[s].begin(), rows[s].end());
        for (std::int32_t m = 0; m < node.members; ++m) columns_.push_back(node.begin + m);
    }
}

void PreconditionerPattern::index_occurrences() {
    first_occurrence_.assign(order_.size() + 1, 0);
    for (const std::int32_t c : columns_) ++first_occurrence_[static_cast<std::size_t>(c) + 1];
    for (std::size_t i = 0; i < order_.size(); ++i) first_occurrence_[i + 1] += first_occurrence_[i];
    occurrences_.resize(columns_.size());
    std::vector<std::size_t> next(first_occurrence_.begin(), first_occurrence_.end() - 1);
    for (std::size_t at = 0; at < columns_.size(); ++at)
        occurrences_[next[static_cast<std::size_t>(columns_[at])]++] = static_cast<std::uint32_t>(at);
}

}  // namespace kontur
