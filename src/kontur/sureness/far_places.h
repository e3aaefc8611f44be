// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "kontur/base/geometry.h"

namespace kontur {

/// The plane through the middles of the three largest clusters of points that are more than half as far from what was drawn
/// as any is; nothing for fewer clusters, or if the three lie on one line. Neighbours in a cluster are less than `reach_mm`
/// apart.
/// Source: MITK's plane proposer (mitkPlaneProposer.cpp), which lays a plane through such clusters.
std::optional<Plane> plane_through_far_places(std::span<const Vec3> points, std::span<const double> distances_mm,
                                              double reach_mm);

}  // namespace kontur
