// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kontur/shape/section.h"

namespace kontur {

/// Axes in a section's plane that turn with what is drawn there, unlike the plane's own (u, v).
class SectionAxes {
public:
    explicit SectionAxes(const Section& section);

    /// Coordinates along the direction in which the outlines spread most (a circle's: to its first point), and across it.
    Point2 from_plane(const Point2& p) const { return {cos_ * p[0] + sin_ * p[1], cos_ * p[1] - sin_ * p[0]}; }
    Point2 to_plane(const Point2& p) const { return {cos_ * p[0] - sin_ * p[1], cos_ * p[1] + sin_ * p[0]}; }

private:
    double cos_ = 1, sin_ = 0;
};

/// A point well inside of a section.
struct Probe {
    Point2 at;
    double depth;         ///< mm to the nearest outline
    std::size_t outline;  ///< the one around it, but for holes
};

/// Of each outline what it encloses, mm2, without the holes in it; 0 for a hole.
std::vector<double> areas_without_holes(const Section& section);

/// A lattice of some hundred points over the section, of more where its walls are thin, those inside of it. It turns with
/// the section.
std::vector<Probe> probes(const Section& section);

/// The largest depth, about the radius of the largest circle in the section; 0 without probes.
double deepest(const std::vector<Probe>& inside);

}  // namespace kontur
