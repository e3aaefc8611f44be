// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/derived_fits.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "kontur/derive/body_outline.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/derived_attributes.h"
#include "kontur/derive/derived_surfaces.h"
#include "viewer/model/file_names.h"

namespace kontur::viewer {
namespace {

const FittedStructure& the_one(const std::vector<FittedStructure>& fitted, Id structure) {
    return *std::ranges::find(fitted, structure, [](const FittedStructure& one) { return one.structure.id; });
}

/// Where it says the same as the mask.
std::optional<ImplicitFunction> function_of(const FittedStructure& one) {
    if (one.shares_border || one.corrected) return std::nullopt;
    return one.made.function;
}

std::vector<NamedStructure> named(const RuleMembers& members, const std::vector<FittedStructure>& fitted) {
    std::vector<NamedStructure> sources;
    for (const auto& [name, id] : members.drawn) {
        const FittedStructure& one = the_one(fitted, id);
        sources.push_back({name, one.made.mask, function_of(one)});
    }
    return sources;
}

std::vector<TriangleMesh> meshes(const RuleMembers& members, const std::vector<FittedStructure>& fitted, const Image& image,
                                 const Work& work) {
    std::vector<ShownStructure> sources;
    for (const auto& [name, id] : members.drawn) {
        const FittedStructure& one = the_one(fitted, id);
        sources.push_back({name, std::make_shared<const TriangleMesh>(*one.made.mesh), function_of(one)});
    }
    DerivedSurfacesOptions options{image.grid};
    options.body = [&](const std::optional<double>& threshold) {
        return std::make_shared<const Mask>(body_outline(image, threshold, work.untold()));
    };
    return derived_surfaces(members.rules, sources, options, work.untold());
}

}  // namespace

std::vector<FittedStructure> fit_derived(const RuleMembers& members, const std::vector<FittedStructure>& fitted,
                                         const State& state, const Image& image, const Work& work) {
    std::vector<DerivedStructure> made = derive(members.rules, named(members, fitted), &image, work);
    std::vector<TriangleMesh> surfaces = meshes(members, fitted, image, work);
    std::vector<FittedStructure> all;
    for (std::size_t n = 0; n < made.size(); ++n) {
        FittedStructure one{structure_of(state, members.made[n]), std::move(made[n].outlines), {}, false, {}, true};
        one.set.attributes = derived_attributes(made[n]);
        one.set.attributes.color = rgb8(one.structure.color);
        one.set.attributes.review = one.structure.attributes.review;
        one.made.mask = std::move(made[n].mask);
        one.made.mesh = std::move(surfaces[n]);
        one.made.report.mask_voxels = std::ranges::count(one.made.mask.values, 1);
        one.made.report.mask_volume_ml =
            static_cast<double>(one.made.report.mask_voxels) * image.grid.voxel_volume_mm3() / 1000;
        all.push_back(std::move(one));
    }
    return all;
}

RuleMembers all_members(const State& state) {
    RuleMembers all;
    for (const auto& [id, structure] : state.structures) {
        if (!structure.rule || std::ranges::count(all.made, id) > 0) continue;
        const RuleMembers members = members_of(state, id);
        // Of something that is not drawn yet nothing can be made, as of a structure without contours.
        if (!std::ranges::all_of(members.drawn, [&](const auto& item) { return has_content(state, item.second); })) continue;
        all.add(members);
    }
    return all;
}

}  // namespace kontur::viewer
