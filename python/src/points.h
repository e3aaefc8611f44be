// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"

namespace kontur::python {

/// Shape (..., 3) to (...). Throws Error(invalid_input) for another one.
std::vector<py::ssize_t> leading_shape(const py::array& points);

inline std::span<const Vec3> span_of(const ArrayOf<double>& points) {
    return {reinterpret_cast<const Vec3*>(points.data()), static_cast<std::size_t>(points.size() / 3)};
}

}  // namespace kontur::python
