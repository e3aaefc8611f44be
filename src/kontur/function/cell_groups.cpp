// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/cell_groups.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace kontur {
namespace {

// Bounds the table of source cells to 2^21 entries.
constexpr double kMostCellsAlong = 128;

/// floor(coordinate / edge); std::floor is a call where the baseline has no instruction for it.
std::int64_t cell_along(double coordinate, double edge) {
    const double quotient = coordinate / edge;
    const auto truncated = static_cast<std::int64_t>(quotient);
    return truncated - static_cast<std::int64_t>(static_cast<double>(truncated) > quotient);
}

Index3 cell_of(const PointArrays& points, std::size_t i, double edge) {
    return {cell_along(points.x[i], edge), cell_along(points.y[i], edge), cell_along(points.z[i], edge)};
}

}  // namespace

CellGroups group_by_cell(const PointArrays& points, double edge) {
    CellGroups groups;
    std::unordered_map<std::uint64_t, std::size_t> numbers;
    std::vector<std::size_t> cell_number(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Index3 cell = cell_of(points, i, edge);
        // Neighbours in the list are often neighbours in space.
        if (i > 0 && groups.cells[cell_number[i - 1]] == cell) {
            cell_number[i] = cell_number[i - 1];
            continue;
        }
        const auto [found, is_new] = numbers.try_emplace(cell_key(cell), groups.cells.size());
        if (is_new) groups.cells.push_back(cell);
        cell_number[i] = found->second;
    }
    groups.starts.assign(groups.cells.size() + 1, 0);
    for (const std::size_t c : cell_number) ++groups.starts[c + 1];
    std::partial_sum(groups.starts.begin(), groups.starts.end(), groups.starts.begin());
    groups.order.resize(points.size());
    std::vector<std::size_t> next(groups.starts.begin(), groups.starts.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) groups.order[next[cell_number[i]]++] = i;
    return groups;
}

SourceCells::SourceCells(const PointArrays& centers, std::span<const double> weights, double edge) : size_{1, 1, 1} {
    Box3 box;
    for (std::size_t i = 0; i < centers.size(); ++i) box.extend(centers[i]);
    if (box.is_empty()) box.extend({});
    const Vec3 size = box.size();
    edge_ = std::max(edge, largest(size) / kMostCellsAlong);
    for (int axis = 0; axis < 3; ++axis) {
        first_[axis] = cell_along(box.min[axis], edge_);
        size_[axis] = cell_along(box.max[axis], edge_) - first_[axis] + 1;
    }
    const auto number = [&](std::size_t i) {
        const Index3 c = cell_of(centers, i, edge_);
        return static_cast<std::size_t>(c.i - first_.i + size_.i * (c.j - first_.j + size_.j * (c.k - first_.k)));
    };
    starts_.assign(static_cast<std::size_t>(size_.i * size_.j * size_.k) + 1, 0);
    for (std::size_t i = 0; i < centers.size(); ++i) ++starts_[number(i) + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for (std::vector<double>* v : {&sources_.x, &sources_.y, &sources_.z, &sources_.w}) v->resize(centers.size());
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const std::size_t place = next[number(i)]++;
        sources_.x[place] = centers.x[i];
        sources_.y[place] = centers.y[i];
        sources_.z[place] = centers.z[i];
        sources_.w[place] = weights[i];
    }
}

void SourceCells::gather_near(const Vec3& box_min, const Vec3& box_max, double radius, NearSources& sources) const {
    for (std::vector<double>* v : {&sources.x, &sources.y, &sources.z, &sources.w}) v->clear();
    const auto range = [&](int axis, double reach) {
        return std::pair{std::max<std::int64_t>(cell_along(box_min[axis] - reach, edge_) - first_[axis], 0),
                         std::min(cell_along(box_max[axis] + reach, edge_) - first_[axis], size_[axis] - 1)};
    };
    const auto squared_distance = [&](int axis, std::int64_t cell) {
        const double low = static_cast<double>(cell + first_[axis]) * edge_;
        const double d = std::max({0.0, low - box_max[axis], box_min[axis] - (low + edge_)});
        return d * d;
    };
    const auto [k_first, k_last] = range(2, radius);
    const auto [j_first, j_last] = range(1, radius);
    for (std::int64_t k = k_first; k <= k_last; ++k) {
        const double rest_k = radius * radius - squared_distance(2, k);
        for (std::int64_t j = j_first; j <= j_last; ++j) {
            const double rest = rest_k - squared_distance(1, j);
            if (rest < 0) continue;
            const auto [i_first, i_last] = range(0, std::sqrt(rest));
            if (i_first <= i_last) append(start(i_first, j, k), start(i_last + 1, j, k), sources);
        }
    }
    while (sources.x.size() % kNearLanes != 0) {
        sources.x.push_back(box_min.x);
        sources.y.push_back(box_min.y);
        sources.z.push_back(box_min.z);
        sources.w.push_back(0);
    }
}

void SourceCells::append(std::size_t begin, std::size_t end, NearSources& sources) const {
    if (begin == end) return;
    const auto append_part = [&](const std::vector<double>& from, std::vector<double>& to) {
        to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                  from.begin() + static_cast<std::ptrdiff_t>(end));
    };
    append_part(sources_.x, sources.x);
    append_part(sources_.y, sources.y);
    append_part(sources_.z, sources.z);
    append_part(sources_.w, sources.w);
}

}  // namespace kontur
