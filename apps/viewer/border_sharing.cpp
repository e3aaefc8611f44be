// SPDX-License-Identifier: Apache-2.0
#include "viewer/border_sharing.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "kontur/editor.h"
#include "kontur/extract/find_surface.h"
#include "kontur/labels/shared_surface.h"

namespace kontur::viewer {
namespace {

constexpr double kStepFraction = 0.0125;     // of the smallest structure's diagonal
constexpr double kMostVoxels = 6e6;          // of the lattice: some seconds at the most
constexpr std::size_t kMostStarts = 20'000;  // each piece of a surface has to have one

Box3 box_of(const LoneSurface& alone) { return bounding_box(alone.mesh->points); }

bool meet(const Box3& a, const Box3& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
    return true;
}

/// Those whose boxes, with some room, meet another's.
std::vector<const LoneSurface*> with_neighbors(const std::vector<LoneSurface>& all) {
    std::vector<Box3> boxes;
    for (const LoneSurface& one : all) {
        const Box3 box = box_of(one);
        boxes.push_back(box.padded(0.02 * box.diagonal() + 1));
    }
    std::vector<const LoneSurface*> found;
    for (std::size_t a = 0; a < all.size(); ++a)
        for (std::size_t b = 0; b < all.size(); ++b)
            if (a != b && meet(boxes[a], boxes[b])) {
                found.push_back(&all[a]);
                break;
            }
    return found;
}

/// Around all of them. Its step and its place change by leaps, so that most edits leave it as it is.
Grid lattice_around(const std::vector<const LoneSurface*>& all) {
    Box3 box = box_of(*all.front());
    double least = box.diagonal();
    for (const LoneSurface* one : all) {
        const Box3 own = box_of(*one);
        box.extend(own.min), box.extend(own.max);
        least = std::min(least, own.diagonal());
    }
    const Vec3 size = box.size();
    const double wanted = std::max(kStepFraction * least, std::cbrt(size.x * size.y * size.z / kMostVoxels));
    const double step = std::exp2(std::ceil(4 * std::log2(wanted)) / 4), leap = 16 * step;
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::floor((box.min[axis] - 2 * step) / leap) * leap,
                     high = std::ceil((box.max[axis] + 2 * step) / leap) * leap;
        grid.index_to_mm.translation[axis] = low;
        grid.size[axis] = std::llround((high - low) / step) + 1;
        Vec3 along;
        along[axis] = step;
        grid.index_to_mm.set_column(axis, along);
    }
    return grid;
}

BoxedMask voxels(const ImplicitFunction& function, const TriangleMesh& mesh, const Grid& lattice, const Work& work) {
    const IndexBox box = index_box(lattice, bounding_box(mesh.points)).value().padded({1, 1, 1}, lattice.size);
    std::vector<Vec3> starts;
    const std::size_t step = 1 + mesh.points.size() / kMostStarts;
    for (std::size_t n = 0; n < mesh.points.size(); n += step) starts.push_back(mesh.points[n]);
    const Grid grid = grid_of(lattice, box);
    return trimmed({box, fill(find_surface(function, grid, std::move(starts), Voxelizer::adaptive, work), work)}, lattice);
}

/// The mesh's code has no zero: where triangles without an area meet any direction will do.
std::vector<Vec3> normals_of(const TriangleMesh& mesh) {
    std::vector<Vec3> normals = point_normals(mesh);
    std::replace(normals.begin(), normals.end(), Vec3{}, Vec3{0, 0, 1});
    return normals;
}

/// Whose surfaces are not what they are alone.
std::set<std::size_t> sharing(const Partition& parts) {
    std::set<std::size_t> found;
    for (std::size_t n = 0; n < parts.pairs.size(); ++n) {
        const StructurePair& pair = parts.pairs[n];
        if (pair.relation == Relation::exclusive && parts.touch[n]) found.insert({pair.first, pair.second});
        if (pair.relation == Relation::inside && pair.is_given) found.insert({pair.first, pair.second});
    }
    return found;
}

}  // namespace

const BoxedMask& BorderSharing::mask_of(const LoneSurface& alone, const Work& work) {
    KnownMask& known = masks_[alone.structure];
    if (known.mesh != alone.mesh) {
        known.mask = voxels(alone.function, *alone.mesh, lattice_, work);
        known.mesh = alone.mesh;
    }
    return known.mask;
}

/// As quickly as a preview: it only decides who owns the gaps.
FittedObject BorderSharing::fit_union(const std::vector<Id>& structures, const ContourSet& outlines, const Work& work) {
    const auto is_same = [](const Contour& a, const Contour& b) { return a.points == b.points && a.hole == b.hole; };
    const auto known = unions_.find(structures);
    if (known != unions_.end() &&
        std::equal(outlines.contours.begin(), outlines.contours.end(), known->second.outlines.contours.begin(),
                   known->second.outlines.contours.end(), is_same))
        return known->second.fitted;
    const EditedSurface all = Editor().preview(outlines, work);
    FittedObject fitted{all.function, {{{0, 0, 0}, {0, 0, 0}}, {grid_of(lattice_, {{0, 0, 0}, {0, 0, 0}}), {0}}}};
    if (!all.mesh.points.empty()) fitted.mask = voxels(all.function, all.mesh, lattice_, work);
    unions_[structures] = {outlines, fitted};
    return fitted;
}

SharedBorders BorderSharing::share(const std::vector<LoneSurface>& alone, const Borders& borders, const Work& work) {
    const std::vector<const LoneSurface*> all = with_neighbors(alone);
    if (all.size() < 2) return {};
    std::vector<std::shared_ptr<const TriangleMesh>> meshes;
    for (const LoneSurface* one : all) meshes.push_back(one->mesh);
    if (meshes == last_meshes_ && borders == last_borders_) return last_;
    last_ = shared_anew(all, borders, work);
    last_meshes_ = std::move(meshes);
    last_borders_ = borders;
    return last_;
}

SharedBorders BorderSharing::shared_anew(const std::vector<const LoneSurface*>& all, const Borders& borders,
                                         const Work& work) {
    SharedBorders result;
    if (const Grid lattice = lattice_around(all); !(lattice == lattice_)) {
        lattice_ = lattice;
        masks_.clear();
        unions_.clear();
    }
    std::vector<Id> ids;
    SingleFits fits;
    std::vector<double> counts;
    for (const LoneSurface* one : all) {
        ids.push_back(one->structure);
        fits.drawn.push_back(one->drawn.get());
        fits.functions.push_back(one->function);
        fits.masks.push_back(mask_of(*one, work));
        const std::vector<std::uint8_t>& values = fits.masks.back().mask.values;
        counts.push_back(static_cast<double>(std::count(values.begin(), values.end(), std::uint8_t{1})));
    }
    const std::vector<ImplicitFunction> functions = fits.functions;
    const Partition parts = partition(
        std::move(fits), lattice_, rules_among(borders, ids),
        [&](std::span<const std::size_t> group, const ContourSet& outlines) {
            std::vector<Id> members;
            for (const std::size_t n : group) members.push_back(ids[n]);
            return fit_union(members, outlines, work);
        },
        work);
    for (const StructurePair& pair : parts.pairs)
        result.pairs.push_back(
            {ids[pair.first], ids[pair.second], pair.relation,
             static_cast<double>(pair.shared_voxels) / std::max(1.0, std::min(counts[pair.first], counts[pair.second])),
             pair.is_given});
    std::vector<std::size_t> members;
    std::vector<BoxedMask> masks;
    std::vector<ImplicitFunction> member_functions;
    for (const std::size_t n : sharing(parts)) {
        members.push_back(n);
        masks.push_back(trimmed(parts.masks[n], lattice_));
        member_functions.push_back(functions[n]);
    }
    work.check();
    const SharedSurface surface = shared_surface(masks, member_functions, lattice_, work);
    for (std::size_t n = 0; n < members.size(); ++n) {
        TriangleMesh own = surface_of(surface, n);
        own.normals = normals_of(own);
        result.meshes[ids[members[n]]] = std::make_shared<const TriangleMesh>(std::move(own));
    }
    return result;
}

}  // namespace kontur::viewer
