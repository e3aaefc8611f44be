// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/function/implicit_function.h"
#include "kontur/shape/contour.h"
#include "kontur/shape/mesh.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// A structure that rules may name. With the function that its mask was made from, margins begin at the function's surface,
/// else at the mask's, whose steps are smoothed.
struct NamedStructure {
    std::string name;
    Mask mask;
    std::optional<ImplicitFunction> function{};
};

/// What a rule makes.
struct DerivedStructure {
    std::string name;
    std::string rule;                  ///< as it was given
    std::vector<std::string> sources;  ///< the structures that it names, in their order in the rule
    Mask mask;                         ///< on the grid of the structures
    ContourSet outlines{};             ///< closed contours around the mask's voxel centres on each slice (constant k), at
                                       ///< sub-voxel places; named after the structure
    TriangleMesh mesh{};               ///< closed, with normals, where it is wanted; without triangles where nothing is left
};

/// The outline of the body in the image above a threshold, on the grid of the structures; see body() in docs/derive.md.
using FindBody = std::function<std::shared_ptr<const Mask>(const std::optional<double>& threshold)>;

struct DeriveOptions {
    const Image* image = nullptr;  ///< in which body() is looked for, once for each threshold; on the structures' grid
    FindBody body{};               ///< in place of the image, for who knows it
    bool mesh = false;             ///< whether surfaces are wanted, too
};

/// Makes structures of structures by rules such as "PTV = CTV + 5 mm - (Cord + 3 mm)" (docs/derive.md). A rule may name what
/// another one makes; results come in the order of the rules. A margin is a distance in mm in space from the surface. With
/// an image there may be no structures. Throws Error(invalid_input), with a mark at the place in the line, for what is no
/// rule, a name that stands for nothing and rules in a circle; for structures of several grids, two of one name and a rule
/// that makes a structure that is there. The same bytes for any number of threads.
std::vector<DerivedStructure> derive(std::span<const std::string> rules, std::span<const NamedStructure> structures,
                                     const DeriveOptions& options = {}, const Work& work = {});

/// Throws what `derive` would throw of the rules for structures of these names, before there is a mask.
void check_rules(std::span<const std::string> rules, std::span<const std::string> structures, bool has_image);

/// The structures that rules name and none of them makes, each once, in the order of the rules. Throws as `derive` does for
/// what is no rule.
std::vector<std::string> sources_of(std::span<const std::string> rules);

/// Two structures against each other.
struct StructureRelation {
    std::string a, b;
    double volume_a_ml = 0, volume_b_ml = 0;
    double overlap_ml = 0;
    std::optional<double> least_distance_mm{};    ///< of the surfaces; 0 where they overlap; nothing when a mask is empty
    double a_beyond_b_mm = 0, b_beyond_a_mm = 0;  ///< how far one sticks out of the other at most
    Vec3 a_beyond_b{}, b_beyond_a{};              ///< mm, where it does
};

/// Each pair of structures, in their order. Throws Error(invalid_input) for structures of several grids.
std::vector<StructureRelation> relations(std::span<const NamedStructure> structures, const Work& work = {});

}  // namespace kontur
