// SPDX-License-Identifier: Apache-2.0
#include "kontur/image/walk_data.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "kontur/sampling/spread_points.h"

namespace kontur {
namespace {

constexpr double kLeastNoise = 0.03, kMostNoise = 3;  // cells
constexpr double kNoiseOfFall = 0.02;                 // noise in cells, times how much the probability falls over one
constexpr double kLeastCrossing = 0.1;                // steps: a surface nearer to a cell's centre counts as so far from it
constexpr std::size_t kMostAnchors = 900;
// Of f that counts, mm over mm. Of ten drawings Dice .8973; half as much at least .8972, twice .8989.
constexpr double kLeastSlope = 0.4;
constexpr double kAnchorNoise = 0.2, kMostAnchorValue = 1.5;  // cells
// Cells: along the drawn lines nothing changes. Half and a quarter of the spacing: the same within .0001 on 34 drawings; 4
// cells lost .02 on one.
constexpr double kLineSpacing = 1.4, kLineNoise = 0.005;

class WalkConstraints {
public:
    WalkConstraints(const WalkDepths& walk, const CellDepths& alone, const WalkDataOptions& options)
        : walk_(walk.walk),
          cells_(walk.cells),
          alone_(alone),
          depths_(walk.depths),
          options_(options),
          is_in_band_(walk_.inside.size()) {
        for (const std::uint32_t cell : walk_.band) is_in_band_[cell] = 1;
    }

    std::vector<PointConstraint> beside_surface(const Affine3& frame) const {
        std::vector<PointConstraint> data;
        for (const std::uint32_t cell : walk_.band) {
            if (!is_off_contours(cell)) continue;
            if (const double steps = steps_to_surface(cell); steps > 0) {
                const double noise = std::clamp(kNoiseOfFall / std::max(fall(cell), 1e-6), kLeastNoise, kMostNoise);
                data.push_back(datum(cell, walk_.is_inside(cell) ? steps : -steps, options_.noise * noise));
            }
        }
        return some(data, options_.most, frame);
    }

    std::vector<PointConstraint> anchors_in_planes(const ImplicitFunction& before, const Affine3& frame,
                                                   const Work& work) const {
        std::vector<PointConstraint> data;
        for (const std::uint32_t cell : walk_.band)
            cells_.visit_neighbours(cell, [&](int, std::size_t next) {
                if (!is_in_band_[next] && walk_.is_inside(next) != walk_.is_inside(cell) && is_off_contours(next))
                    data.push_back(datum(next, 0, kAnchorNoise));
            });
        data = some(data, kMostAnchors, frame);
        std::vector<Vec3> places;
        for (const PointConstraint& one : data) places.push_back(one.position);
        std::vector<double> values(places.size());
        before.values(places, values, work);
        const double most = kMostAnchorValue * cells_.edge_mm();
        for (std::size_t n = 0; n < data.size(); ++n) data[n].value = std::clamp(values[n], -most, most);
        return data;
    }

    /// How far the surface moves outwards near a place; 0 where no cell is below one of the two.
    double change_mm(const Vec3& p) const {
        const double change = depth_at(p, depths_.depth_mm, depths_.nearest) - depth_at(p, alone_.depth_mm, alone_.nearest);
        return std::isfinite(change) ? change : 0;
    }

private:
    /// Below a surface; beyond the cells by the way from that of its cells which is nearest to the nearest of all cells.
    double depth_at(const Vec3& p, const std::vector<float>& depth_mm, const std::vector<std::uint32_t>& nearest) const {
        const Index3 at = nearest_index(to_index_.apply(p));
        Index3 cell = at;
        for (int axis = 0; axis < 3; ++axis) cell[axis] = std::clamp<std::int64_t>(at[axis], 0, cells_.grid.size[axis] - 1);
        const std::size_t n = cells_.offset(cell);
        return cells_.holds(at) ? static_cast<double>(depth_mm[n]) : -distance(p, cells_.center(nearest[n]));
    }

    PointConstraint datum(std::size_t cell, double steps, double noise) const {
        const double edge = cells_.edge_mm();
        return {.position = cells_.center(cell), .value = steps * edge, .noise_mm = noise * edge};
    }

    bool is_off_contours(std::size_t cell) const { return is_longer(alone_.far_mm[cell], options_.off_contours, cells_); }

    double value(std::size_t cell) const { return static_cast<double>(walk_.inside[cell]) - 0.5; }

    /// From a cell's centre to the plane that passes where the walk's surface crosses the nearest step along each axis; 0
    /// where it crosses none.
    double steps_to_surface(std::size_t cell) const {
        std::array<double, 3> least{};  // the inverse of the way to the crossing
        cells_.visit_neighbours(cell, [&](int side, std::size_t next) {
            if (walk_.is_inside(next) == walk_.is_inside(cell)) return;
            const double way = std::max(value(cell) / (value(cell) - value(next)), kLeastCrossing);
            double& along = least[static_cast<std::size_t>(side / 2)];
            along = std::max(along, 1 / way);
        });
        const double sum = least[0] * least[0] + least[1] * least[1] + least[2] * least[2];
        return sum > 0 ? 1 / std::sqrt(sum) : 0;
    }

    /// How much the probability changes from cell to cell, where it changes most.
    double fall(std::size_t cell) const {
        constexpr int kAround = 2;
        const Index3 at = cells_.index(cell);
        Vec3 sum;
        double squares = 0;
        for (int k = -kAround; k <= kAround; ++k)
            for (int j = -kAround; j <= kAround; ++j)
                for (int i = -kAround; i <= kAround; ++i) {
                    const Index3 near{at.i + i, at.j + j, at.k + k};
                    if (!cells_.holds(near)) continue;
                    const double weight = std::exp(-0.5 * (i * i + j * j + k * k));
                    sum += weight * value(cells_.offset(near)) * Vec3{1.0 * i, 1.0 * j, 1.0 * k};
                    squares += weight * i * i;
                }
        return norm(sum) / squares;
    }

    /// About so many of them, evenly.
    static std::vector<PointConstraint> some(const std::vector<PointConstraint>& all, std::size_t most,
                                             const Affine3& frame) {
        if (all.size() <= most) return all;
        std::map<std::array<double, 3>, std::size_t> number;
        std::vector<Vec3> places;
        for (const PointConstraint& one : all) {
            number.emplace(std::array{one.position.x, one.position.y, one.position.z}, places.size());
            places.push_back(one.position);
        }
        std::vector<PointConstraint> selection;
        for (const Vec3& p : spread(places, most, frame)) selection.push_back(all[number.at({p.x, p.y, p.z})]);
        return selection;
    }

    const VoxelWalk& walk_;
    const ImageCells& cells_;
    const CellDepths& alone_;
    const Depths& depths_;  ///< below the walk's surface
    Affine3 to_index_ = cells_.grid.index_to_mm.inverse();
    const WalkDataOptions& options_;
    std::vector<std::uint8_t> is_in_band_;
};

std::vector<PointConstraint> drawn_lines(const ContourSet& contours, double edge_mm) {
    std::vector<PointConstraint> lines;
    for (const Vec3& p :
         along_contours(contours, std::max(kLineSpacing * edge_mm, length_mm(contours) / kMostContourPoints)))
        lines.push_back({.position = p, .value = 0, .noise_mm = kLineNoise * edge_mm});
    return lines;
}

/// Far from the contours f rises by less than the way. What is told of it rises alike, or f would have to bend and change
/// beside the contours.
void as_steep_as(const ImplicitFunction& function, std::vector<PointConstraint>& depths, const Work& work) {
    std::vector<Vec3> places, gradients(depths.size());
    for (const PointConstraint& one : depths) places.push_back(one.position);
    function.gradients(places, gradients, work);
    for (std::size_t n = 0; n < depths.size(); ++n) depths[n].value *= std::max(norm(gradients[n]), kLeastSlope);
}

}  // namespace

ImageData walk_data(const WalkDepths& walk, const FitDepths& alone, const Drawing& drawing, const WalkDataOptions& options,
                    const Work& work) {
    const Affine3 frame = frame_of(drawing.contours);
    const WalkConstraints constraints(walk, alone.depths, options);
    ImageData data{constraints.beside_surface(frame), {}};
    as_steep_as(alone.fitted.function, data.values, work);
    std::ranges::copy(constraints.anchors_in_planes(alone.fitted.function, frame, work), std::back_inserter(data.values));
    data.change_mm = [constraints](const Vec3& p) { return constraints.change_mm(p); };
    data.changes = drawn_lines(drawing.contours, walk.cells.edge_mm());
    return data;
}

Depths depths_below(const VoxelWalk& walk, const ImageCells& cells) {
    std::vector<std::uint8_t> inside(walk.inside.size());
    for (std::size_t n = 0; n < inside.size(); ++n) inside[n] = walk.is_inside(n);
    return depths_of(inside, cells);
}

}  // namespace kontur
