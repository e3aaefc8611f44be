// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/track.h"
#include "kontur/moving/moving_function.h"
#include "kontur/shape/mesh.h"

namespace kontur {

/// Surfaces of a moving object at all times, on one lattice, for a screen. What is inside at two moments, or outside, stays
/// so between them; so values at all moments are computed where moments differ and along their surfaces, and a surface is
/// made of these values alone. Safe to read from several threads.
class MeshCourse {
public:
    /// `starts` are points of each moment's surface, mm: components that none of them touches are left out, as of masks.
    /// `spacing_mm` is that of the lattice; it becomes larger where the lattice would have more than `kMostPoints`. Throws
    /// Error(invalid_input) unless there are starts of each moment, and as preview_lattice does.
    MeshCourse(const MovingFunction& function, const std::vector<std::vector<Vec3>>& starts, double spacing_mm,
               const Work& work = {});
    static constexpr double kMostPoints = 1 << 24;  ///< of the lattice, times the number of moments

    /// Closed, oriented outward, with outward unit normals; empty where nothing is inside.
    TriangleMesh at(double time) const;

    /// MovingFunction::changes at points of the surface at that time, of the lattice's values.
    std::vector<double> changes(const std::vector<Vec3>& points_mm, double time) const;

    double spacing_mm() const { return grid_.spacing_mm().x; }

private:
    void mark_moments(const std::vector<SurfaceLattice>& surfaces);
    void choose_points(const std::vector<SurfaceLattice>& surfaces);
    void evaluate(const MovingFunction& function, const Work& work);
    std::optional<std::size_t> number_of(const Index3& point) const;

    TimeCourse course_;
    Grid grid_;
    std::vector<std::vector<bool>> inside_;  ///< at each moment, of each point of the lattice
    std::vector<Index3> points_;             ///< whose values are known, i fastest
    std::vector<Index3> cells_;              ///< between such points alone
    std::vector<float> values_;              ///< of each of them at all moments, mm
};

}  // namespace kontur
