// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/labels/partition.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "viewer/model/border_rules.h"

namespace kontur::viewer {

/// A structure as it was fitted by itself.
struct LoneSurface {
    Id structure = 0;
    std::shared_ptr<const ContourSet> drawn;
    ImplicitFunction function;
    std::shared_ptr<const TriangleMesh> mesh;  ///< closed
};

/// How two structures that touch lie to each other, or two that a rule is about.
struct BorderPair {
    Id first = 0, second = 0;
    Relation relation = Relation::exclusive;
    double share = 0;       ///< of the smaller one's voxels, as fitted alone, that both have
    bool is_given = false;  ///< by a rule; else the relation follows from the share

    friend bool operator==(const BorderPair&, const BorderPair&) = default;
};

struct SharedBorders {
    /// Surfaces, with normals, of structures that have borders in common with others: there they have the same triangles.
    std::map<Id, std::shared_ptr<const TriangleMesh>> meshes;
    std::vector<BorderPair> pairs;
};

/// Fits a structure once more, to what it drew and borrows.
using Refit = std::function<LoneSurface(const LoneSurface& alone, const ContourSet& with_borrowed, const Work& work)>;

/// Lets fitted structures share their borders (see `partition`) on a lattice of its own, some 80 steps across the smallest
/// of them. Remembers the voxels of structures, the unions of those that touch, and what has been fitted again: what has not
/// changed costs nothing the next time. Structures whose boxes meet no other's are left out. Throws as `partition` and
/// `refit` do, and Error(cancelled).
class BorderSharing {
public:
    /// With `refit` a border that one structure alone has drawn in a plane is its neighbour's, too (see `borrowed_borders`).
    SharedBorders share(const std::vector<LoneSurface>& alone, const Borders& borders, const Work& work = {},
                        const Refit& refit = {});

private:
    struct KnownUnion {
        ContourSet outlines;
        FittedObject fitted;
    };
    struct KnownRefit {
        std::shared_ptr<const TriangleMesh> alone;  ///< the surface that borrowed
        std::vector<SurfacePoint> borrowed;
        LoneSurface surface;
    };
    using Surfaces = std::vector<const LoneSurface*>;
    struct UnionPartition {
        Partition parts;
        std::map<std::vector<std::size_t>, ImplicitFunction> unions;  ///< by the numbers of those that touch
    };

    SharedBorders shared_anew(Surfaces all, const Borders& borders, const Work& work, const Refit& refit);
    void take_lattice_around(const Surfaces& all);
    UnionPartition parted(const Surfaces& all, const Borders& borders, const Work& work);
    Surfaces with_borrowed_borders(const Surfaces& all, const UnionPartition& alone, const Work& work, const Refit& refit);
    const LoneSurface* refitted(const LoneSurface& alone, const std::vector<SurfacePoint>& borrowed, const Work& work,
                                const Refit& refit);
    const BoxedMask& mask_of(const LoneSurface& surface, const Work& work);
    std::vector<BorderPair> pairs_of(const Surfaces& all, const Partition& parts, const Work& work);
    FittedObject fit_union(const std::vector<Id>& structures, const ContourSet& outlines, const Work& work);

    std::vector<std::shared_ptr<const TriangleMesh>> last_meshes_;  ///< of the structures that have neighbours
    Borders last_borders_;
    SharedBorders last_;
    Grid lattice_{};
    std::map<std::shared_ptr<const TriangleMesh>, BoxedMask> masks_;  ///< by the surface whose voxels they are
    std::map<std::vector<Id>, KnownUnion> unions_;
    std::map<Id, KnownRefit> refits_;
};

}  // namespace kontur::viewer
