// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "kontur/base/parallel.h"
#include "kontur/base/point_tree.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/structure_levels.h"

namespace kontur {
namespace {

/// A structure as what distances need of it.
struct Body {
    Levels levels;
    std::vector<Vec3> points;  ///< of the surface, mm
    PointTree tree;
    double volume_ml;
};

std::int64_t shared_voxels(const Mask& a, const Mask& b) {
    std::int64_t count = 0;
    for (std::size_t n = 0; n < a.values.size(); ++n) count += (a.values[n] != 0) && (b.values[n] != 0);
    return count;
}

/// Of each surface point of `a` the distance from the surface of `b`.
std::vector<double> distances_to(const Body& b, const Body& a, const Work& work) {
    std::vector<double> distances(a.points.size());
    parallel_for(static_cast<std::int64_t>(distances.size()), 1024, work, [&](std::int64_t begin, std::int64_t end) {
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n)
            distances[n] = b.tree.distance_to(a.points[n]);
    });
    return distances;
}

struct Farthest {
    double mm = 0;
    Vec3 place;
};

/// Of the points of `a` out of `b`.
Farthest farthest_out(const Body& a, const Body& b, const std::vector<double>& distances, const Grid& grid) {
    const Affine3 to_index = grid.index_to_mm.inverse();
    const double step_mm = shortest_step(grid);
    Farthest found;
    for (std::size_t n = 0; n < distances.size(); ++n)
        if (distances[n] > found.mm && !(level_at(b.levels, to_index.apply(a.points[n]), step_mm) > 0))
            found = {distances[n], a.points[n]};
    return found;
}

}  // namespace

std::vector<StructureRelation> relations(std::span<const NamedStructure> structures, const Work& work) {
    check_structures(structures);
    std::vector<StructureRelation> found;
    if (structures.empty()) return found;
    const Grid& grid = structures.front().mask.grid;
    const double voxel_ml = grid.voxel_volume_mm3() / 1000;
    const WorkLattice lattice = work_lattice(grid);
    std::vector<Body> bodies;
    for (const NamedStructure& one : structures) {
        Levels levels = structure_levels(one, lattice, work);
        std::vector<Vec3> points = surface_points(levels, lattice.grid);
        PointTree tree(points);
        bodies.push_back({std::move(levels), std::move(points), std::move(tree),
                          static_cast<double>(shared_voxels(one.mask, one.mask)) * voxel_ml});
    }
    for (std::size_t a = 0; a < bodies.size(); ++a)
        for (std::size_t b = a + 1; b < bodies.size(); ++b) {
            work.check();
            StructureRelation& one = found.emplace_back(
                StructureRelation{structures[a].name, structures[b].name, bodies[a].volume_ml, bodies[b].volume_ml});
            one.overlap_ml = static_cast<double>(shared_voxels(structures[a].mask, structures[b].mask)) * voxel_ml;
            if (bodies[a].points.empty() || bodies[b].points.empty()) continue;
            const std::vector<double> from_a = distances_to(bodies[b], bodies[a], work),
                                      from_b = distances_to(bodies[a], bodies[b], work);
            one.least_distance_mm = one.overlap_ml > 0 ? 0 : *std::min_element(from_a.begin(), from_a.end());
            const Farthest out_a = farthest_out(bodies[a], bodies[b], from_a, lattice.grid),
                           out_b = farthest_out(bodies[b], bodies[a], from_b, lattice.grid);
            one.a_beyond_b_mm = out_a.mm, one.a_beyond_b = out_a.place;
            one.b_beyond_a_mm = out_b.mm, one.b_beyond_a = out_b.place;
        }
    return found;
}

}  // namespace kontur
