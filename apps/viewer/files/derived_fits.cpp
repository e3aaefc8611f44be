// SPDX-License-Identifier: Apache-2.0
#include "viewer/files/derived_fits.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "kontur/derive/derived_attributes.h"
#include "viewer/model/file_names.h"

namespace kontur::viewer {
namespace {

const FittedStructure& the_one(const std::vector<FittedStructure>& fitted, Id structure) {
    return *std::ranges::find(fitted, structure, [](const FittedStructure& one) { return one.structure.id; });
}

/// Where it says the same as the mask.
std::optional<ImplicitFunction> function_of(const FittedStructure& one) {
    if (one.shares_border || one.corrected) return std::nullopt;
    return one.segmentation.function;
}

std::vector<NamedStructure> named(const RuleMembers& members, const std::vector<FittedStructure>& fitted) {
    std::vector<NamedStructure> sources;
    for (const auto& [name, id] : members.drawn) {
        const FittedStructure& one = the_one(fitted, id);
        sources.push_back({name, one.segmentation.mask, function_of(one)});
    }
    return sources;
}

}  // namespace

std::vector<FittedStructure> fit_derived(const RuleMembers& members, const std::vector<FittedStructure>& fitted,
                                         const State& state, const DeriveOptions& options, const Work& work) {
    std::vector<DerivedStructure> derived = derive(members.rules, named(members, fitted), options, work);
    const double voxel_ml = options.image->grid.voxel_volume_mm3() / 1000;
    std::vector<FittedStructure> all;
    for (std::size_t n = 0; n < derived.size(); ++n) {
        FittedStructure one{structure_of(state, members.derived[n]), std::move(derived[n].outlines), {}, false, {}, true};
        one.set.attributes = derived_attributes(derived[n]);
        one.set.attributes.color = rgb8(one.structure.color);
        one.set.attributes.review = one.structure.attributes.review;
        one.segmentation.mask = std::move(derived[n].mask);
        if (options.mesh) one.segmentation.mesh = std::move(derived[n].mesh);
        one.segmentation.report.mask_voxels = std::ranges::count(one.segmentation.mask.values, 1);
        one.segmentation.report.mask_volume_ml = static_cast<double>(one.segmentation.report.mask_voxels) * voxel_ml;
        all.push_back(std::move(one));
    }
    return all;
}

RuleMembers all_members(const State& state) {
    RuleMembers all;
    for (const auto& [id, structure] : state.structures) {
        if (!structure.rule || std::ranges::count(all.derived, id) > 0) continue;
        const RuleMembers members = members_of(state, id);
        // Of something that is not drawn yet nothing can be made, as of a structure without contours.
        if (!std::ranges::all_of(members.drawn, [&](const auto& item) { return has_content(state, item.second); })) continue;
        all.add(members);
    }
    return all;
}

}  // namespace kontur::viewer
