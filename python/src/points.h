// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "casters.h"

namespace kontur::python {

/// Shape (..., 3) to (...). Throws Error(invalid_input) for another one.
std::vector<py::ssize_t> leading_shape(const py::array& points);

/// The numbers of a one-dimensional array of `what`. Throws Error(invalid_input) for another shape.
std::vector<double> list_of(const ArrayOf<double>& numbers, const char* what);

inline std::span<const Vec3> span_of(const ArrayOf<double>& points) {
    return {reinterpret_cast<const Vec3*>(points.data()), static_cast<std::size_t>(points.size() / 3)};
}

}  // namespace kontur::python
