// SPDX-License-Identifier: Apache-2.0
#include "viewer/surfaces/border_sharing.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "kontur/editor.h"
#include "kontur/extract/find_surface.h"
#include "kontur/labels/borrowed_borders.h"
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

const BoxedMask& BorderSharing::mask_of(const LoneSurface& surface, const Work& work) {
    auto known = masks_.find(surface.mesh);
    if (known == masks_.end())
        known = masks_.emplace(surface.mesh, voxels(surface.function, *surface.mesh, lattice_, work)).first;
    return known->second;
}

/// As quickly as a preview: it only decides who owns the gaps.
FittedObject BorderSharing::fit_union(const std::vector<Id>& structures, const ContourSet& outlines, const Work& work) {
    const auto is_same = [](const Contour& a, const Contour& b) {
        return a.points == b.points && a.hole == b.hole && a.end == b.end && a.weight == b.weight;
    };
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

SharedBorders BorderSharing::share(const std::vector<LoneSurface>& alone, const Borders& borders, const Work& work,
                                   const Refit& refit) {
    const Surfaces all = with_neighbors(alone);
    if (all.size() < 2) return {};
    std::vector<std::shared_ptr<const TriangleMesh>> meshes;
    for (const LoneSurface* one : all) meshes.push_back(one->mesh);
    if (meshes == last_meshes_ && borders == last_borders_) return last_;
    last_ = shared_anew(all, borders, work, refit);
    last_meshes_ = std::move(meshes);
    last_borders_ = borders;
    return last_;
}

void BorderSharing::take_lattice_around(const Surfaces& all) {
    const Grid lattice = lattice_around(all);
    if (lattice == lattice_) return;
    lattice_ = lattice;
    masks_.clear();
    unions_.clear();
}

BorderSharing::UnionPartition BorderSharing::parted(const Surfaces& all, const Borders& borders, const Work& work) {
    take_lattice_around(all);
    std::vector<Id> ids;
    SingleFits fits;
    for (const LoneSurface* one : all) {
        ids.push_back(one->structure);
        fits.drawn.push_back(one->drawn.get());
        fits.functions.push_back(one->function);
        fits.masks.push_back(mask_of(*one, work));
    }
    UnionPartition parted;
    const auto fit = [&](std::span<const std::size_t> group, const ContourSet& outlines) {
        std::vector<Id> members;
        for (const std::size_t n : group) members.push_back(ids[n]);
        FittedObject fitted = fit_union(members, outlines, work);
        parted.unions.insert_or_assign({group.begin(), group.end()}, fitted.function);
        return fitted;
    };
    parted.parts = partition(std::move(fits), lattice_, rules_among(borders, ids), fit, work);
    return parted;
}

const LoneSurface* BorderSharing::refitted(const LoneSurface& alone, const std::vector<SurfacePoint>& borrowed,
                                           const Work& work, const Refit& refit) {
    KnownRefit& known = refits_[alone.structure];
    if (known.alone != alone.mesh || known.borrowed != borrowed) {
        ContourSet more = *alone.drawn;
        more.surface.insert(more.surface.end(), borrowed.begin(), borrowed.end());
        known.surface = refit(alone, more, work);
        known.alone = alone.mesh;
        known.borrowed = borrowed;
    }
    return &known.surface;
}

BorderSharing::Surfaces BorderSharing::with_borrowed_borders(const Surfaces& all, const UnionPartition& alone,
                                                             const Work& work, const Refit& refit) {
    Surfaces surfaces = all;
    for (const auto& [group, function] : alone.unions) {
        Neighbours neighbours;
        neighbours.all = &function;
        for (const std::size_t n : group) {
            neighbours.drawn.push_back(all[n]->drawn.get());
            neighbours.functions.push_back(&surfaces[n]->function);
        }
        const auto borrowed = borrowed_borders(neighbours, work);
        for (std::size_t member = 0; member < group.size(); ++member)
            if (!borrowed[member].empty())
                surfaces[group[member]] = refitted(*all[group[member]], borrowed[member], work, refit);
    }
    return surfaces;
}

std::vector<BorderPair> BorderSharing::pairs_of(const Surfaces& all, const Partition& parts, const Work& work) {
    const auto count = [&](std::size_t n) {
        const std::vector<std::uint8_t>& values = mask_of(*all[n], work).mask.values;
        return static_cast<double>(std::count(values.begin(), values.end(), std::uint8_t{1}));
    };
    std::vector<BorderPair> pairs;
    for (const StructurePair& pair : parts.pairs)
        pairs.push_back(
            {all[pair.first]->structure, all[pair.second]->structure, pair.relation,
             static_cast<double>(pair.shared_voxels) / std::max(1.0, std::min(count(pair.first), count(pair.second))),
             pair.is_given});
    return pairs;
}

SharedBorders BorderSharing::shared_anew(Surfaces all, const Borders& borders, const Work& work, const Refit& refit) {
    std::erase_if(masks_, [](const auto& known) { return known.first.use_count() == 1; });  // nobody else has it any more
    UnionPartition now = parted(all, borders, work);
    if (Surfaces borrowed = refit ? with_borrowed_borders(all, now, work, refit) : all; borrowed != all) {
        all = std::move(borrowed);
        now = parted(all, borders, work);
    }
    SharedBorders result;
    result.pairs = pairs_of(all, now.parts, work);
    std::vector<std::size_t> members;
    std::vector<BoxedMask> masks;
    std::vector<ImplicitFunction> functions;
    for (const std::size_t n : sharing(now.parts)) {
        members.push_back(n);
        masks.push_back(trimmed(now.parts.masks[n], lattice_));
        functions.push_back(all[n]->function);
    }
    work.check();
    const SharedSurface surface = shared_surface(masks, functions, lattice_, work);
    for (std::size_t n = 0; n < members.size(); ++n) {
        TriangleMesh own = surface_of(surface, n);
        own.normals = normals_of(own);
        result.meshes[all[members[n]]->structure] = std::make_shared<const TriangleMesh>(std::move(own));
    }
    return result;
}

}  // namespace kontur::viewer
