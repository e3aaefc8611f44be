// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derived_surfaces.h"

#include <map>
#include <utility>

#include "kontur/derive/evaluate.h"
#include "kontur/derive/function_levels.h"
#include "kontur/derive/level_mesh.h"
#include "kontur/derive/mask_levels.h"
#include "kontur/derive/rule_order.h"
#include "kontur/extract/mesh_mask.h"
#include "kontur/shape/index_box.h"

namespace kontur {
namespace {

constexpr std::int64_t kSpareVoxels = 3;  ///< around what rules reach: levels are smoothed over one

/// Where something may lie, mm; nothing: anywhere in the image.
using Extent = std::optional<Box3>;
using Extents = std::map<std::string, Extent>;

Extent of_both(const Extent& a, const Extent& b) {
    if (!a || !b) return std::nullopt;
    Box3 box = *a;
    for (const Vec3& corner : {b->min, b->max})
        if (!b->is_empty()) box.extend(corner);
    return box;
}

double reach_of(const Expression& e) {
    return e.operation == Operation::margin ? e.lengths.largest() : e.operation == Operation::margin_along ? norm(e.way) : 0;
}

Extent extent_of(const Expression& e, const Extents& known) {
    switch (e.operation) {
        case Operation::name:
            return known.at(e.name);
        case Operation::body:
            return std::nullopt;
        case Operation::join:
            return of_both(extent_of(e.operands[0], known), extent_of(e.operands[1], known));
        case Operation::meet: {
            const Extent first = extent_of(e.operands[0], known);
            return first ? first : extent_of(e.operands[1], known);
        }
        default:
            break;
    }
    const Extent inner = extent_of(e.operands[0], known);
    return inner && e.side == MarginSide::outwards ? Extent(inner->padded(reach_of(e))) : inner;
}

/// How far the rule looks at most from a place to tell what it makes there.
double sight_of(const Expression& e) {
    double sight = reach_of(e);
    for (const Expression& operand : e.operands) sight += sight_of(operand);
    return sight;
}

/// The part of the image in which something may come to lie, or decide about it.
IndexBox region_of(const std::vector<Rule>& rules, const std::vector<std::size_t>& order,
                   std::span<const ShownStructure> structures, const Grid& image) {
    const IndexBox whole{{0, 0, 0}, {image.size.i - 1, image.size.j - 1, image.size.k - 1}};
    Extents known;
    Extent all = Box3{};
    double sight = 0;
    for (const ShownStructure& one : structures) known[one.name] = bounding_box(one.mesh->points);
    for (const std::size_t n : order) {
        const Extent extent = known[rules[n].name] = extent_of(rules[n].expression, known);
        all = of_both(all, extent);
        sight += sight_of(rules[n].expression);
    }
    if (!all) return whole;
    const std::optional<IndexBox> box = index_box(image, all->padded(sight));
    if (!box) return whole;
    return box->padded({kSpareVoxels, kSpareVoxels, kSpareVoxels}, image.size);
}

/// Voxels of the image that stand for some of their neighbours.
struct Voxels {
    Grid grid;
    Index3 first{}, step{1, 1, 1};  ///< in voxels of the image
};

/// Of long voxels the short sides grow first.
Voxels voxels_in(const IndexBox& region, const Grid& image, std::int64_t most) {
    Voxels voxels{grid_of(image, region), region.low};
    const Vec3 spacing = image.spacing_mm();
    const Index3 all = region.size();
    const auto length = [&](int axis) { return spacing[axis] * static_cast<double>(voxels.step[axis]); };
    while (most > 0 && voxels.grid.voxel_count() > most) {
        int axis = 0;
        for (int other = 1; other < 3; ++other)
            if (length(other) < length(axis)) axis = other;
        ++voxels.step[axis];
        voxels.grid.size[axis] = (all[axis] + voxels.step[axis] - 1) / voxels.step[axis];
        voxels.grid.index_to_mm.set_column(axis, image.index_to_mm.column(axis) * static_cast<double>(voxels.step[axis]));
    }
    return voxels;
}

Mask part_of(const Mask& whole, const Voxels& voxels) {
    const Grid& grid = voxels.grid;
    Mask part{grid, std::vector<std::uint8_t>(static_cast<std::size_t>(grid.voxel_count()))};
    for (std::int64_t k = 0; k < grid.size.k; ++k)
        for (std::int64_t j = 0; j < grid.size.j; ++j)
            for (std::int64_t i = 0; i < grid.size.i; ++i)
                part.values[grid.offset(i, j, k)] =
                    whole.values[whole.grid.offset(voxels.first.i + i * voxels.step.i, voxels.first.j + j * voxels.step.j,
                                                   voxels.first.k + k * voxels.step.k)];
    return part;
}

Levels levels_of(const ShownStructure& one, const RuleScene& scene, const Grid& grid, const Work& work) {
    const Mask mask = voxelize_mesh(*one.mesh, grid, work).mask;
    return one.function ? function_levels(*one.function, mask, scene.lattice, work) : mask_levels(mask, scene.lattice, work);
}

}  // namespace

std::vector<TriangleMesh> derived_surfaces(std::span<const std::string> texts, std::span<const ShownStructure> structures,
                                           const DerivedSurfacesOptions& options, const Work& work) {
    std::vector<std::string> names;
    for (const ShownStructure& one : structures) names.push_back(one.name);
    check_rules(texts, names, options.body != nullptr);
    const std::vector<Rule> rules = read_rules(texts);
    const std::vector<std::size_t> order = order_of(rules);
    const Voxels voxels = voxels_in(region_of(rules, order, structures, options.grid), options.grid, options.most_voxels);
    RuleScene scene{work_lattice(voxels.grid)};
    scene.body = [&](const std::optional<double>& threshold) {
        return mask_levels(part_of(*options.body(threshold), voxels), scene.lattice, work.untold());
    };
    for (const ShownStructure& one : structures) scene.levels[one.name] = levels_of(one, scene, voxels.grid, work.untold());
    std::vector<TriangleMesh> meshes(rules.size());
    double done = 0;
    for (const std::size_t n : order) {
        work.report("derive", done++ / static_cast<double>(order.size()));
        Levels& levels = scene.levels[rules[n].name];
        levels = evaluate(rules[n].expression, scene, work.untold());
        meshes[n] = level_mesh(levels, scene.lattice.grid, work);
    }
    return meshes;
}

}  // namespace kontur
