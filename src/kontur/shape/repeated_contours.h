// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

#include "kontur/shape/contour.h"

namespace kontur {

/// The closed lines seen so far. One repeats another that runs through the same points, whatever its start, direction and
/// points that repeat a neighbour.
class SeenRings {
public:
    /// Points are the same when they round to the same multiples of `tolerance_mm`.
    explicit SeenRings(double tolerance_mm) : tolerance_mm_(tolerance_mm) {}

    /// Whether no ring before ran through these points.
    bool add(const std::vector<Vec3>& points);

private:
    using Ring = std::vector<std::array<double, 3>>;

    Ring canonical(const std::vector<Vec3>& points) const;

    double tolerance_mm_;
    std::set<Ring> seen_;
};

/// Leaves out closed contours that repeat one before them, hole for hole and with the same end: even-odd filling would have
/// the two cancel each other, and nobody means that by drawing one twice. Points are the same up to 1e-6 of the drawing's
/// diameter. Returns what was left out in one sentence, if anything was.
std::vector<std::string> leave_out_repetitions(ContourSet& set);

/// Checks a set (check_contours, which throws), and leaves out of it what says nothing: contours that enclose nothing
/// (leave_out_lines), then those that repeat others (leave_out_repetitions). Returns the sentences of both.
std::vector<std::string> check_and_tidy(ContourSet& set);

/// The same for contours of any number of moments; a contour of another moment is no repetition.
std::vector<std::string> check_and_tidy_moments(ContourSet& set);

}  // namespace kontur
