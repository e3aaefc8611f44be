// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/multiscale_order.h"

#include <algorithm>
#include <cmath>

namespace kontur {
namespace {

constexpr int kDeepestLevel = 21;

/// Bits of v moved to every third position.
std::uint64_t spread_bits(std::uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffffull;
    v = (v | v << 16) & 0x1f0000ff0000ffull;
    v = (v | v << 8) & 0x100f00f00f00f00full;
    v = (v | v << 4) & 0x10c30c30c30c30c3ull;
    return (v | v << 2) & 0x1249249249249249ull;
}

struct CodedPoint {
    std::uint64_t morton;
    std::int32_t point;
    bool is_taken = false;
};

double squared_distance(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

}  // namespace

MultiscaleOrder multiscale_order(const PointArrays& points) {
    const std::size_t n = points.size();
    Box3 box;
    for (std::size_t i = 0; i < n; ++i) box.extend(points[i]);
    const Vec3 extent = box.size();
    const double side = std::max({extent.x, extent.y, extent.z, 1e-300}) * (1 + 1e-9);
    const double to_cell = (1 << kDeepestLevel) / side;
    const auto cell = [&](double v, double low) { return static_cast<std::uint64_t>((v - low) * to_cell); };

    std::vector<CodedPoint> coded(n);
    for (std::size_t i = 0; i < n; ++i)
        coded[i] = {spread_bits(cell(points.x[i], box.min.x)) | spread_bits(cell(points.y[i], box.min.y)) << 1 |
                        spread_bits(cell(points.z[i], box.min.z)) << 2,
                    static_cast<std::int32_t>(i)};
    std::sort(coded.begin(), coded.end(), [](const CodedPoint& a, const CodedPoint& b) {
        return a.morton != b.morton ? a.morton < b.morton : a.point < b.point;
    });

    MultiscaleOrder result;
    result.order.reserve(n);
    result.level_begin.push_back(0);
    for (int level = 1; level <= kDeepestLevel && result.order.size() < n; ++level) {
        const double width = side / (1 << level);
        const int shift = 3 * (kDeepestLevel - level);
        std::size_t next = 0;
        for (std::size_t begin = 0; begin < n; begin = next) {
            bool covered = false;
            for (next = begin; next < n && coded[next].morton >> shift == coded[begin].morton >> shift; ++next)
                covered |= coded[next].is_taken;
            if (covered) continue;
            // The cell's point nearest to its centre represents it.
            Vec3 center;
            const Vec3 any = points[static_cast<std::size_t>(coded[begin].point)];
            for (int axis = 0; axis < 3; ++axis)
                center[axis] = box.min[axis] + (std::floor((any[axis] - box.min[axis]) / width) + 0.5) * width;
            std::size_t best = begin;
            double best_distance = std::numeric_limits<double>::infinity();
            for (std::size_t q = begin; q < next; ++q) {
                const double d = squared_distance(points[static_cast<std::size_t>(coded[q].point)], center);
                if (d < best_distance) {
                    best_distance = d;
                    best = q;
                }
            }
            coded[best].is_taken = true;
            result.order.push_back(coded[best].point);
        }
        result.level_begin.push_back(static_cast<std::int32_t>(result.order.size()));
        result.spacing.push_back(width);
    }
    if (result.order.size() < n) {  // points closer than the deepest level resolves
        for (const CodedPoint& c : coded)
            if (!c.is_taken) result.order.push_back(c.point);
        result.level_begin.push_back(static_cast<std::int32_t>(n));
        result.spacing.push_back(result.spacing.back());
    }
    return result;
}

}  // namespace kontur
