// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"
#include "kontur/base/point_tree.h"
#include "kontur/base/work.h"
#include "kontur/correct/correction_data.h"
#include "kontur/function/point_arrays.h"

namespace kontur {

/// Matern's kernel of smoothness 3/2: how alike the mask's errors are at two places, from 1 to 0.
double likeness(double distance_mm, double length_mm);

/// g, by which corrections change f0: a Gaussian process of mean 0 with Matern's kernel of smoothness 3/2,
/// k(r) = (1 + sqrt(3) r/l) exp(-sqrt(3) r/l), given what the corrections say. What they add and what they remove are two
/// such processes, each without the other sign: beside a deep change an interpolant swings to the other side, and nobody
/// asked for that. Beyond kReachLengths l from every place where the surface moves it is 0; it fades over the last quarter
/// of that way.
class SurfaceChange {
public:
    /// No change.
    SurfaceChange() = default;

    std::vector<double> values(std::span<const Vec3> positions, const Work& work = {}) const;
    bool is_zero() const { return added_.empty() && removed_.empty(); }

    /// Where it may differ from 0, mm.
    Box3 box() const;
    double length_mm() const { return length_mm_; }
    double reach_mm() const { return kReachLengths * length_mm_; }
    /// The largest change that the corrections ask for, mm.
    double largest_mm() const { return largest_mm_; }
    /// The mean of those at the places where the surface moves, mm.
    double mean_mm() const { return mean_mm_; }
    /// From the nearest place where the surface moves; infinity without one.
    double distance_to_moved(const Vec3& position) const;
    std::size_t center_count() const { return centers_.size(); }

private:
    friend class ChangeSolver;

    PointArrays centers_;                  ///< in units in which k is the screened kernel
    std::vector<double> added_, removed_;  ///< weights of the two parts of g; none where a part is 0
    std::vector<Vec3> moved_;
    std::optional<PointTree> moved_tree_;
    double length_mm_ = 0, largest_mm_ = 0, mean_mm_ = 0;
};

/// More data and bounds than this are not solved for.
inline constexpr std::size_t kMostCorrectionCenters = 8000;

/// Solves for g. A bound takes part where f0 + g would break it, and then holds f at its limit. Throws
/// Error(too_large) beyond kMostCorrectionCenters centres.
SurfaceChange solve_change(const ExistingSurface& surface, const CorrectionData& data, const CorrectionLengths& lengths,
                           const Work& work = {});

}  // namespace kontur
