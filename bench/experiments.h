// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "kontur/phantom/cases.h"

/// The measurements of Heckel, Konrad & Peitgen 2010 on a case of the phantom. Each returns a list with one object per row
/// of its table; times are medians of up to `repeat` runs, see `measure`.
namespace kontur::bench {

using Json = nlohmann::ordered_json;

/// Table 1: the time to solve the paper's linear system, by solver and number of threads.
Json solving(const PhantomCase& phantom, int repeat);

/// Table 2: the time to voxelize the implicit functions of the paper's and of kontur's normals, and how the masks agree with
/// evaluating every voxel.
Json voxelizing(const PhantomCase& phantom, int repeat);

/// Table 3: what reducing the contours' points to a fraction q saves and costs, overlap against q = 1 of the same
/// configuration and against the truth.
Json reduction(const PhantomCase& phantom, int repeat);

/// Seconds by stage as an object.
Json stages(const std::vector<std::pair<std::string, double>>& seconds);

/// From contours to mask by stage, and peak memory, for kontur's pipeline and the paper's.
Json end_to_end(const PhantomCase& phantom, int repeat);

/// From an edit of one contour to the preview's surface at 2 mm, while that contour is dragged to and fro; and how far the
/// previews are from the finished surfaces.
Json editing(const PhantomCase& phantom, int repeat);

/// While that contour is dragged: the preview, and what rules make of it, each with how much longer the processors work for
/// both than for the preview alone.
Json deriving(const PhantomCase& phantom, int repeat);

/// Of the body's mask: until it can be corrected, from an edit to the corrected surface, and the same where nothing is kept
/// from one edit to the next.
Json correcting(const PhantomCase& phantom, int repeat);

}  // namespace kontur::bench
