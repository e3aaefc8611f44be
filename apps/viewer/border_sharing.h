// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/labels/partition.h"
#include "kontur/shape/grid.h"
#include "kontur/shape/mesh.h"
#include "viewer/border_rules.h"

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

/// Lets fitted structures share their borders (see `partition`) on a lattice of its own, some 80 steps across the smallest
/// of them. Remembers the voxels of structures and the unions of those that touch: what has not changed costs nothing the
/// next time. Structures whose boxes meet no other's are left out. Throws as `partition` does, and Error(cancelled).
class BorderSharing {
public:
    SharedBorders share(const std::vector<LoneSurface>& alone, const Borders& borders, const Work& work = {});

private:
    struct KnownMask {
        std::shared_ptr<const TriangleMesh> mesh;  ///< of the surface whose voxels these are
        BoxedMask mask;
    };
    struct KnownUnion {
        ContourSet outlines;
        FittedObject fitted;
    };

    SharedBorders shared_anew(const std::vector<const LoneSurface*>& all, const Borders& borders, const Work& work);
    const BoxedMask& mask_of(const LoneSurface& alone, const Work& work);
    FittedObject fit_union(const std::vector<Id>& structures, const ContourSet& outlines, const Work& work);

    std::vector<std::shared_ptr<const TriangleMesh>> last_meshes_;  ///< of the structures that have neighbours
    Borders last_borders_;
    SharedBorders last_;
    Grid lattice_{};
    std::map<Id, KnownMask> masks_;
    std::map<std::vector<Id>, KnownUnion> unions_;
};

}  // namespace kontur::viewer
