// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/structure_levels.h"

#include <fmt/format.h>

#include "kontur/base/error.h"
#include "kontur/derive/function_levels.h"
#include "kontur/derive/mask_levels.h"

namespace kontur {

Levels structure_levels(const NamedStructure& structure, const WorkLattice& lattice, const Work& work) {
    return structure.function ? function_levels(*structure.function, structure.mask, lattice, work)
                              : mask_levels(structure.mask, lattice, work);
}

void check_one_grid(const Grid& grid, std::string_view whose, const Grid& first) {
    constexpr double kSameMm = 1e-3;
    check_grid(grid);
    const double apart = corner_distance_mm(grid, first);
    if (!(apart <= kSameMm))
        throw Error(
            ErrorKind::invalid_input,
            fmt::format("the grid of {} has {} x {} x {} voxels, that of the first structure {} x {} x {}, and their "
                        "corners lie {:g} mm apart; {} mm are the most",
                        whose, grid.size.i, grid.size.j, grid.size.k, first.size.i, first.size.j, first.size.k, apart,
                        kSameMm));
}

void check_structures(std::span<const NamedStructure> structures) {
    for (std::size_t n = 0; n < structures.size(); ++n) {
        const NamedStructure& one = structures[n];
        if (one.name.empty())
            throw Error(ErrorKind::invalid_input,
                        fmt::format("structure {} has no name, by which rules could name it", n + 1));
        check_mask(one.mask, fmt::format("the mask of '{}'", one.name));
        check_one_grid(one.mask.grid, fmt::format("'{}'", one.name), structures.front().mask.grid);
        for (std::size_t other = 0; other < n; ++other)
            if (structures[other].name == one.name)
                throw Error(ErrorKind::invalid_input,
                            fmt::format("structures {} and {} are both '{}'; rules need different names", other + 1, n + 1,
                                        one.name));
    }
}

}  // namespace kontur
