// SPDX-License-Identifier: Apache-2.0
#include "kontur/function/far_field.h"

#include <algorithm>
#include <atomic>

#include "kontur/base/parallel.h"

namespace kontur {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Nodes are summed over together in cubes of this many spacings: their near centres are nearly the same.
constexpr double kNodeGroupSpacings = 2;
constexpr std::int64_t kGroupsPerChunk = 16;
// A tenth of the time after which a caller must hear from us.
constexpr std::int64_t kKernelValuesPerBatch = 20'000'000;

PointArrays part(const PointArrays& points, std::size_t begin, std::size_t end) {
    const auto cut = [&](const std::vector<double>& v) {
        return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(begin),
                                   v.begin() + static_cast<std::ptrdiff_t>(end));
    };
    PointArrays result;
    result.x = cut(points.x);
    result.y = cut(points.y);
    result.z = cut(points.z);
    return result;
}

Vec3 as_vector(const Index3& index) {
    return {static_cast<double>(index.i), static_cast<double>(index.j), static_cast<double>(index.k)};
}

Index3 block_of(const Index3& node) { return {node.i >> 3, node.j >> 3, node.k >> 3}; }
std::size_t within_block(const Index3& node) {
    return static_cast<std::size_t>((node.i & 7) + 8 * ((node.j & 7) + 8 * (node.k & 7)));
}

/// Calls visit(node, its value) for the nodes of a cell's stencil, i fastest. They lie in at most 2 x 2 x 2 blocks, which
/// are looked up once.
template <typename BlockAt, typename Visit>
void for_each_stencil_node(const Index3& cell, const BlockAt& block_at, const Visit& visit) {
    const Index3 first{cell.i - kStencilBefore, cell.j - kStencilBefore, cell.k - kStencilBefore};
    const Index3 low = block_of(first), high = block_of({first.i + 7, first.j + 7, first.k + 7});
    std::array<decltype(block_at(low)), 8> blocks{};
    for (int n = 0; n < 8; ++n) {
        const Index3 number{low.i + (n & 1), low.j + (n >> 1 & 1), low.k + (n >> 2)};
        if (number.i <= high.i && number.j <= high.j && number.k <= high.k)
            blocks[static_cast<std::size_t>(n)] = block_at(number);
    }
    for (std::int64_t k = first.k; k < first.k + 8; ++k)
        for (std::int64_t j = first.j; j < first.j + 8; ++j)
            for (std::int64_t i = first.i; i < first.i + 8; ++i) {
                const Index3 node{i, j, k}, number = block_of(node);
                const auto n =
                    static_cast<std::size_t>((number.i - low.i) + 2 * (number.j - low.j) + 4 * (number.k - low.k));
                visit(node, (*blocks[n])[within_block(node)]);
            }
}

}  // namespace

void DirectSum::values(const PointArrays& points, std::span<double> out, const Work& work) {
    const std::size_t centers = function_.centers().size();
    const std::size_t batch = std::max<std::size_t>(1024, kKernelValuesPerBatch / std::max<std::size_t>(centers, 1));
    for (std::size_t begin = 0; begin < points.size(); begin += batch) {
        work.check();
        const std::size_t end = std::min(points.size(), begin + batch);
        function_.sums_at(part(points, begin, end), out.subspan(begin, end - begin), work);
    }
    kernel_values_ += static_cast<std::int64_t>(points.size() * centers);
}

FarField::FarField(const ImplicitFunction& function, double spacing, std::unique_ptr<PointEvaluator> nodes)
    : near_kernel_(function.kernel(), kRadius * spacing),
      spacing_(spacing),
      sources_(function.centers(), function.weights(), spacing),
      nodes_(std::move(nodes)) {}

template <typename Add>
void FarField::for_each_group(const CellGroups& groups, double edge, const Work& work, const Add& add) {
    std::atomic<std::int64_t> kernel_values{0};
    const auto cells = static_cast<std::int64_t>(groups.cells.size());
    parallel_for(cells, kGroupsPerChunk, work, [&](std::int64_t begin, std::int64_t end) {
        NearSources sources;
        for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
            const Vec3 low = edge * as_vector(groups.cells[c]);
            sources_.gather_near(low, low + Vec3{edge, edge, edge}, kRadius * spacing_, sources);
            const std::span<const std::size_t> members(groups.order.data() + groups.starts[c],
                                                       groups.starts[c + 1] - groups.starts[c]);
            add(groups.cells[c], members, sources);
            kernel_values += static_cast<std::int64_t>(sources.x.size() * members.size());
        }
    });
    kernel_values_ += kernel_values;
}

void FarField::values(const PointArrays& points, std::span<double> out, const Work& work) {
    const CellGroups groups = group_by_cell(points, spacing_);
    prepare(groups.cells, work);
    for_each_group(groups, spacing_, work,
                   [&](const Index3& cell, std::span<const std::size_t> members, const NearSources& near) {
                       const StencilValues nodes = stencil(cell);
                       for (const std::size_t m : members)
                           out[m] = near_kernel_.value(near, points[m]) + interpolate(nodes, within(cell, points[m]));
                   });
}

void FarField::gradients(const PointArrays& points, std::span<Vec3> out, const Work& work) {
    const CellGroups groups = group_by_cell(points, spacing_);
    prepare(groups.cells, work);
    for_each_group(
        groups, spacing_, work, [&](const Index3& cell, std::span<const std::size_t> members, const NearSources& near) {
            const StencilValues nodes = stencil(cell);
            for (const std::size_t m : members)
                out[m] =
                    near_kernel_.gradient(near, points[m]) + interpolate_gradient(nodes, within(cell, points[m])) / spacing_;
        });
}

Vec3 FarField::within(const Index3& cell, const Vec3& point) const { return point / spacing_ - as_vector(cell); }

void FarField::prepare(const std::vector<Index3>& cells, const Work& work) {
    const std::vector<Index3> nodes = missing_nodes(cells);
    const std::vector<double> values = smooth_values(nodes, work);
    for (std::size_t n = 0; n < nodes.size(); ++n) block(block_of(nodes[n]))[within_block(nodes[n])] = values[n];
}

std::vector<double> FarField::smooth_values(const std::vector<Index3>& nodes, const Work& work) {
    std::vector<Vec3> positions;
    positions.reserve(nodes.size());
    for (const Index3& node : nodes) positions.push_back(spacing_ * as_vector(node));
    const PointArrays points(positions);
    std::vector<double> values(nodes.size());
    nodes_->values(points, values, work);
    const double edge = kNodeGroupSpacings * spacing_;
    for_each_group(group_by_cell(points, edge), edge, work,
                   [&](const Index3&, std::span<const std::size_t> members, const NearSources& near) {
                       for (const std::size_t m : members) values[m] -= near_kernel_.value(near, points[m]);
                   });
    return values;
}

FarField::NodeBlock& FarField::block(const Index3& number) {
    auto& slot = blocks_[cell_key(number)];
    if (!slot) {
        slot = std::make_unique<NodeBlock>();
        slot->fill(kUnknown);
    }
    return *slot;
}

std::vector<Index3> FarField::missing_nodes(const std::vector<Index3>& cells) {
    constexpr double pending = 0;
    std::vector<Index3> nodes;
    for (const Index3& cell : cells)
        if (prepared_.insert(cell_key(cell)).second)
            for_each_stencil_node(
                cell, [&](const Index3& number) { return &block(number); },
                [&](const Index3& node, double& value) {
                    if (!std::isnan(value)) return;
                    value = pending;
                    nodes.push_back(node);
                });
    return nodes;
}

StencilValues FarField::stencil(const Index3& cell) const {
    StencilValues result;
    std::size_t next = 0;
    for_each_stencil_node(
        cell, [&](const Index3& number) { return blocks_.at(cell_key(number)).get(); },
        [&](const Index3&, double value) { result[next++] = value; });
    return result;
}

}  // namespace kontur
