// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/extract/preview.h"
#include "kontur/function/implicit_function.h"

namespace kontur {

/// Where the surface runs, to a few spacings: enough to cut it by planes long before there is a mesh. Safe to read from
/// several threads.
class SurfaceBand {
public:
    /// Follows the surface that `preview_surface` would give for the same arguments, on every fourth point of its lattice.
    /// Throws as that does.
    SurfaceBand(const ImplicitFunction& function, std::span<const Vec3> starts, const PreviewOptions& options = {},
                const Work& work = {});

    /// Closed lines in mm where the plane cuts the surface: the zero level of the function on points of the plane that are
    /// a spacing apart, as far as they lie in the band. What is left of differences to the mesh's outline is both's linear
    /// interpolation. Evaluates some six points per spacing of the line's length.
    std::vector<std::vector<Vec3>> cut(const Plane& plane) const;

    /// Values that following the surface took.
    std::int64_t evaluations() const { return evaluations_; }

private:
    bool is_in_lattice(const Vec3& index) const;
    bool contains(const Vec3& index) const;
    std::optional<std::size_t> place_of(const Index3& coarse_cell) const;

    ImplicitFunction function_;
    PreviewOptions options_;
    int threads_ = 0;
    Affine3 mm_to_index_;
    Index3 size_{};  ///< of the lattice
    // A box of coarse cells, and which of them the surface passes.
    Index3 first_cell_{}, cells_along_{};
    std::vector<bool> is_passed_;
    Box3 box_mm_;
    std::int64_t evaluations_ = 0;
};

}  // namespace kontur
