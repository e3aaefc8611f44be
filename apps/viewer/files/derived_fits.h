// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/derive/derive.h"
#include "viewer/files/structure_exports.h"
#include "viewer/model/structure_rules.h"

namespace kontur::viewer {

/// What rules make of fitted structures, among them all that is drawn and needed, as `kontur derive` makes it: where borders
/// are shared, or corrections made, of the masks, else of the functions, too. On the grid of the image, which the options
/// have. Throws what `derive` does.
std::vector<FittedStructure> fit_derived(const RuleMembers& members, const std::vector<FittedStructure>& fitted,
                                         const State& state, const DeriveOptions& options, const Work& work);

/// All that rules make in the project of what has something drawn. Throws as `members_of`.
RuleMembers all_members(const State& state);

}  // namespace kontur::viewer
