// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kontur/correct/corrected_section.h"
#include "kontur/correct/existing_surface.h"

namespace kontur {

/// A place where the corrected f is known.
struct CorrectionDatum {
    Vec3 position;    ///< mm
    double value_mm;  ///< of f
    double noise_mm;  ///< standard deviation
    std::size_t section;
};

/// A place where the side is known: sign * f >= least.
struct CorrectionBound {
    Vec3 position;  ///< mm
    double sign;    ///< +1 inside, -1 outside
    double least_mm;
    std::size_t section;
};

struct CorrectionData {
    std::vector<CorrectionDatum> data;
    std::vector<CorrectionBound> bounds;
    std::vector<double> moved_shares;         ///< of each section: CorrectedSection's
    std::vector<std::string> contradictions;  ///< of contours that cross each other, one sentence each
};

/// Lengths of a correction, mm, which follow from the mask alone.
struct CorrectionLengths {
    double length;   ///< l of the kernel
    double step;     ///< of lattices in drawn planes: the smallest voxel side
    double spacing;  ///< of data along a line that was moved
    double depth;    ///< tau: no bound asks for more
};
CorrectionLengths correction_lengths(const ExistingSurface& surface, double reach);

/// What sections and points say. Data lie on drawn lines and a little beside the stretches that move; bounds anywhere in a
/// plane that was looked at, within reach of them, and beyond a drawn end. Contours that contradict each other by more than
/// a step both yield.
CorrectionData correction_data(const ExistingSurface& surface, const std::vector<CorrectedSection>& sections,
                               const ContourSet& drawing, const CorrectionLengths& lengths);

}  // namespace kontur
