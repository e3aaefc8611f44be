// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/section.h"

namespace kontur {

/// A point well inside of a section.
struct Probe {
    Point2 at;
    double depth;  ///< mm to the nearest outline
};

/// A lattice of some hundred points over the section, those inside of it.
std::vector<Probe> probes(const Section& section);

}  // namespace kontur
