// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kontur/base/geometry.h"

namespace kontur {

/// Points as separate coordinate arrays, the layout that bulk evaluation runs on.
struct PointArrays {
    std::vector<double> x, y, z;

    PointArrays() = default;
    explicit PointArrays(std::span<const Vec3> points);

    std::size_t size() const { return x.size(); }
    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

}  // namespace kontur
