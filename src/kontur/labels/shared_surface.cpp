// SPDX-License-Identifier: Apache-2.0
#include "kontur/labels/shared_surface.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>

#include "kontur/labels/filled_map.h"
#include "kontur/labels/region_map.h"

namespace kontur {
namespace {

constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();

/// Depths of objects at the voxels on either side of their borders.
class BorderDepths {
public:
    BorderDepths(const RegionMap& map, std::span<const ImplicitFunction> functions, const Grid& grid, const Work& work)
        : size_(map.box().size()), low_(map.box().low), depths_(functions.size()) {
        std::vector<std::vector<Index3>> voxels(functions.size());
        collect(map, voxels);
        for (std::size_t object = 0; object < functions.size(); ++object) {
            std::vector<Vec3> places;
            for (const Index3& at : voxels[object]) places.push_back(grid.center_mm(at.i, at.j, at.k));
            const std::vector<double> depths = depths_mm(functions[object], places, work);
            for (std::size_t n = 0; n < depths.size(); ++n) depths_[object][key(voxels[object][n])] = depths[n];
        }
    }

    double at(std::size_t object, const Index3& voxel) const { return depths_[object].at(key(voxel)); }

private:
    std::size_t key(const Index3& at) const {
        return static_cast<std::size_t>(at.i - low_.i + size_.i * (at.j - low_.j + size_.j * (at.k - low_.k)));
    }

    /// Each voxel once for each object.
    void collect(const RegionMap& map, std::vector<std::vector<Index3>>& voxels) {
        const auto note = [&](std::size_t object, const Index3& at) {
            if (depths_[object].emplace(key(at), 0.0).second) voxels[object].push_back(at);
        };
        const Index3 &low = map.box().low, &high = map.box().high;
        for (std::int64_t k = low.k; k <= high.k; ++k)
            for (std::int64_t j = low.j; j <= high.j; ++j)
                for (std::int64_t i = low.i; i <= high.i; ++i)
                    for (int axis = 0; axis < 3; ++axis) {
                        const Index3 here{i, j, k};
                        Index3 next = here;
                        if (++next[axis] > high[axis]) continue;
                        const Region a = map.at(here), b = map.at(next);
                        if (a == b) continue;
                        for (const Region region : {a, b})
                            for (const std::size_t object : map.regions()[region])
                                if (map.is_member(a, object) != map.is_member(b, object))
                                    note(object, here), note(object, next);
                    }
    }

    Index3 size_, low_;
    std::vector<std::unordered_map<std::size_t, double>> depths_;
};

/// Where a difference of depths is 0 between two voxels, from 0 to 1; the middle where it has one sign, as where a voxel
/// changed hands.
struct BorderCrossing {
    double along = 0.5;
    bool is_known = false;
};

BorderCrossing crossing(double here, double next) {
    constexpr double kLeast = 0.02;  // of the way, so that no triangle collapses
    if ((here > 0) == (next > 0)) return {};
    return {std::clamp(here / (here - next), kLeast, 1 - kLeast), true};
}

class Net {
public:
    Net(const RegionMap& map, std::span<const ImplicitFunction> functions, const Grid& grid, const Work& work)
        : map_(map),
          functions_(functions),
          depths_(map, functions, grid, work),
          grid_(grid),
          work_(work),
          cells_(map.box().size()),
          of_object_(functions.size()) {
        for (int axis = 0; axis < 3; ++axis) --cells_[axis];
        is_mirrored_ = grid.index_to_mm.determinant() < 0;
    }

    SharedSurface make() {
        surface_.regions = map_.regions();
        const Index3 &low = map_.box().low, &high = map_.box().high;
        below_.assign(static_cast<std::size_t>(cells_.i * cells_.j), kNoPoint);
        for (std::int64_t k = low.k; k < high.k; ++k) {
            add_points(k);
            for (std::int64_t j = low.j; j < high.j; ++j)
                for (std::int64_t i = low.i; i < high.i; ++i)
                    for (int axis = 0; axis < 3; ++axis) add_quad({i, j, k}, axis);
            below_.swap(here_);
        }
        move_to_surfaces();
        return std::move(surface_);
    }

private:
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

    std::size_t place(std::int64_t i, std::int64_t j) const {
        return static_cast<std::size_t>(i - map_.box().low.i + cells_.i * (j - map_.box().low.j));
    }

    /// Of the cells between the slices k and k + 1.
    void add_points(std::int64_t k) {
        const Index3 &low = map_.box().low, &high = map_.box().high;
        here_.assign(static_cast<std::size_t>(cells_.i * cells_.j), kNoPoint);
        for (std::int64_t j = low.j; j < high.j; ++j)
            for (std::int64_t i = low.i; i < high.i; ++i) {
                Vec3 sum;
                int count = 0;
                std::size_t own = kNone;
                for (int axis = 0; axis < 3; ++axis)
                    for (int corner = 0; corner < 4; ++corner) {
                        Index3 a{i, j, k};
                        a[(axis + 1) % 3] += corner & 1, a[(axis + 2) % 3] += corner >> 1;
                        Index3 b = a;
                        ++b[axis];
                        if (map_.at(a) == map_.at(b)) continue;
                        Vec3 at{static_cast<double>(a.i), static_cast<double>(a.j), static_cast<double>(a.k)};
                        const BorderCrossing crossing = crossing_between(a, b);
                        at[axis] += crossing.along;
                        sum += at, ++count;
                        const std::size_t object = crossing.is_known ? only_object(map_.at(a), map_.at(b)) : kNone;
                        own = count == 1 || own == object ? object : kNone;
                    }
                if (count == 0) continue;
                here_[place(i, j)] = static_cast<std::uint32_t>(surface_.mesh.points.size());
                if (own != kNone) of_object_[own].push_back(surface_.mesh.points.size());
                surface_.mesh.points.push_back(grid_.index_to_mm.apply((1.0 / count) * sum));
            }
    }

    /// The object that alone makes the difference between two regions; kNone for several.
    std::size_t only_object(Region a, Region b) const {
        std::vector<std::size_t> differing;
        std::set_symmetric_difference(map_.regions()[a].begin(), map_.regions()[a].end(), map_.regions()[b].begin(),
                                      map_.regions()[b].end(), std::back_inserter(differing));
        return differing.size() == 1 ? differing.front() : kNone;
    }

    /// The mean of crossings lies within a curved surface. One step of Newton's takes it there, where one object alone ends.
    void move_to_surfaces() {
        const double farthest_mm = smallest(grid_.spacing_mm()) / 2;
        for (std::size_t object = 0; object < functions_.size(); ++object) {
            std::vector<Vec3> places, gradients;
            for (const std::size_t n : of_object_[object]) places.push_back(surface_.mesh.points[n]);
            std::vector<double> values(places.size());
            gradients.resize(places.size());
            functions_[object].values_and_gradients(places, values, gradients, work_);
            for (std::size_t n = 0; n < places.size(); ++n) {
                const double slope = norm(gradients[n]);
                if (!(std::abs(values[n]) < farthest_mm * slope)) continue;
                surface_.mesh.points[of_object_[object][n]] -= (values[n] / (slope * slope)) * gradients[n];
            }
        }
    }

    /// The objects that end between two voxels: the deepest of those on either side.
    BorderCrossing crossing_between(const Index3& a, const Index3& b) const {
        const Region here = map_.at(a), next = map_.at(b);
        const auto deepest = [&](Region in, Region out, const Index3& at) {
            double depth = -std::numeric_limits<double>::infinity();
            for (const std::size_t object : map_.regions()[in])
                if (!map_.is_member(out, object)) depth = std::max(depth, depths_.at(object, at));
            return depth;
        };
        const double own_a = deepest(here, next, a), own_b = deepest(here, next, b);
        const double other_a = deepest(next, here, a), other_b = deepest(next, here, b);
        const bool ends = own_a > -std::numeric_limits<double>::infinity(),
                   begins = other_a > -std::numeric_limits<double>::infinity();
        if (ends && begins) return crossing(own_a - other_a, own_b - other_b);
        return ends ? crossing(own_a, own_b) : crossing(-other_a, -other_b);
    }

    std::uint32_t point(const Index3& cell, std::int64_t k) const {
        return (cell.k == k ? here_ : below_)[place(cell.i, cell.j)];
    }

    /// Around the edge from a voxel to the next one along an axis: the points of the four cells beside it.
    void add_quad(const Index3& voxel, int axis) {
        const Index3& low = map_.box().low;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        if (voxel[u] == low[u] || voxel[v] == low[v]) return;  // at the box's faces nothing is
        Index3 next = voxel;
        ++next[axis];
        const Region behind = map_.at(voxel), front = map_.at(next);
        if (behind == front) return;
        std::array<std::uint32_t, 4> around;
        constexpr std::array<std::array<int, 2>, 4> kTurns{{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
        for (std::size_t n = 0; n < 4; ++n) {
            Index3 cell = voxel;
            cell[u] += kTurns[n][0], cell[v] += kTurns[n][1];
            around[n] = point(cell, voxel.k);
        }
        if (is_mirrored_) std::swap(around[1], around[3]);
        const auto apart = [&](std::size_t a, std::size_t b) {
            return norm(surface_.mesh.points[around[a]] - surface_.mesh.points[around[b]]);
        };
        const std::size_t first = apart(0, 2) <= apart(1, 3) ? 0 : 1;
        for (const std::size_t turn : {first, first + 2}) {
            surface_.mesh.triangles.push_back({around[turn % 4], around[(turn + 1) % 4], around[(turn + 2) % 4]});
            surface_.sides.push_back({behind, front});
        }
    }

    const RegionMap& map_;
    std::span<const ImplicitFunction> functions_;
    BorderDepths depths_;
    const Grid& grid_;
    const Work& work_;
    Index3 cells_;
    std::vector<std::vector<std::size_t>> of_object_;  ///< points where one object alone ends
    bool is_mirrored_ = false;
    std::vector<std::uint32_t> below_, here_;  ///< points of the cells of two layers
    SharedSurface surface_;
};

}  // namespace

SharedSurface shared_surface(std::span<const BoxedMask> objects, std::span<const ImplicitFunction> functions,
                             const Grid& grid, const Work& work) {
    if (objects.empty()) return {{}, {{}}, {}};
    const RegionMap map(objects);
    return Net(map, functions, grid, work).make();
}

TriangleMesh surface_of(const SharedSurface& surface, std::size_t object) {
    const auto is_in = [&](Region region) {
        const auto& members = surface.regions[region];
        return std::find(members.begin(), members.end(), object) != members.end();
    };
    TriangleMesh own;
    std::vector<std::uint32_t> places(surface.mesh.points.size(), kNoPoint);
    for (std::size_t n = 0; n < surface.sides.size(); ++n) {
        const bool behind = is_in(surface.sides[n][0]), front = is_in(surface.sides[n][1]);
        if (behind == front) continue;
        std::array<std::uint32_t, 3> triangle = surface.mesh.triangles[n];
        if (front) std::swap(triangle[1], triangle[2]);
        for (std::uint32_t& corner : triangle) {
            std::uint32_t& place = places[corner];
            if (place == kNoPoint) {
                place = static_cast<std::uint32_t>(own.points.size());
                own.points.push_back(surface.mesh.points[corner]);
            }
            corner = place;
        }
        own.triangles.push_back(triangle);
    }
    return own;
}

}  // namespace kontur
