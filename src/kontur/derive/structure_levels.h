// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "kontur/base/work.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/levels.h"

namespace kontur {

/// A given structure on the lattice, by its function where it has one.
Levels structure_levels(const NamedStructure& structure, const WorkLattice& lattice, const Work& work);

/// Throw Error(invalid_input) for grids that differ by more than 0.001 mm at a corner, and for structures of which that
/// holds, which have no name, or two of which have the same one.
void check_one_grid(const Grid& grid, std::string_view whose, const Grid& first);
void check_structures(std::span<const NamedStructure> structures);

}  // namespace kontur
