// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kontur/base/work.h"

namespace kontur {

/// A place of a random walk on a lattice: where it may go on, how readily, and where it may end.
struct WalkPlace {
    static constexpr std::int32_t kNowhere = -1;
    std::array<std::int32_t, 6> next{kNowhere, kNowhere, kNowhere, kNowhere, kNowhere, kNowhere};
    std::array<float, 6> weight{};  ///< of the step there; that of the step back is the same
    double ends = 0;         ///< sum of the weights of steps on which the walk ends; > 0 somewhere in each connected part
    double ends_inside = 0;  ///< the part of them that ends inside
};

/// How walks on an image's voxels weigh looks and depths, for a label's voxels (correct) as for cells (voxel_walk.h).
inline constexpr double kLookContrast = 100;      ///< how much a difference of looks hinders a step
inline constexpr double kLeastStepWeight = 1e-3;  ///< of a step between looks that have nothing in common
inline constexpr double kLogistic = 1.7;          ///< the logistic function that is like the normal distribution's
inline constexpr double kLookExamples = 2000;     ///< about so many voxels teach what looks mean

/// For each place the probability that a walk from it ends inside (Grady 2006): x with
/// (ends + sum w) x - sum w x_next = ends_inside, by conjugate gradients scaled by the diagonal, until the residual is less
/// than `tolerance` times the ends. The same bytes always: one thread, sums in the order of the places.
std::vector<double> walk_inside(const std::vector<WalkPlace>& places, double tolerance, const Work& work = {});

}  // namespace kontur
