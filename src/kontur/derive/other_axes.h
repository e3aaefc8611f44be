// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "kontur/base/work.h"
#include "kontur/derive/levels.h"

namespace kontur {

/// Whether a grid's axes stand on each other at right angles, to 0.001.
bool is_orthogonal(const Grid& grid);

/// Along which of the grid's axes each patient axis x, y, z runs, and whether against it; nullopt for axes that are oblique
/// by more than 0.001.
struct PatientAxis {
    int axis = 0;
    bool is_against = false;
};
std::optional<std::array<PatientAxis, 3>> patient_axes(const Grid& grid);

/// A lattice along x, y, z whose steps are the grid's shortest.
Grid patient_lattice(const Grid& grid);

/// The levels on another lattice, by trilinear interpolation.
Levels on_lattice(const Levels& levels, const Grid& from, const Grid& to, const Work& work);

}  // namespace kontur
