// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"
#include "kontur/derive/rule.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// What rules are worked out with.
struct RuleScene {
    WorkLattice lattice;
    std::function<Levels(const std::optional<double>& threshold)> body{};  ///< not needed where no rule asks for it
    std::map<std::string, Levels> levels{};                                ///< of each structure that is known so far
};

/// Every structure that the expression names is in the scene. Throws Error(invalid_input) as body_outline does.
Levels evaluate(const Expression& expression, const RuleScene& scene, const Work& work);

}  // namespace kontur
