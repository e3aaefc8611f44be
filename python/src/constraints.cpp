// SPDX-License-Identifier: Apache-2.0
#include "kontur/solve/constraint_set.h"

#include <cmath>

#include "bindings.h"
#include "points.h"

namespace kontur::python {
namespace {

ConstraintSet constraints_from(std::vector<Vec3> centers, const ArrayOf<double>& values,
                               const std::optional<ArrayOf<double>>& trust, const std::optional<ArrayOf<double>>& noise_mm) {
    ConstraintSet set;
    set.centers = std::move(centers);
    set.values = list_of(values, "values");
    if (trust) set.trust = list_of(*trust, "trust");
    if (noise_mm) set.noise_mm = list_of(*noise_mm, "noise_mm");
    if (set.values.size() != set.size())
        throw Error(ErrorKind::invalid_input,
                    std::to_string(set.size()) + " constraints have " + std::to_string(set.values.size()) + " values");
    if (!set.trust.empty() && set.trust.size() != set.size())
        throw Error(ErrorKind::invalid_input,
                    std::to_string(set.size()) + " constraints have the trust of " + std::to_string(set.trust.size()));
    for (const double value : set.trust)
        if (!(value > 0))
            throw Error(ErrorKind::invalid_input,
                        "the trust of a constraint is " + std::to_string(value) + "; it must be > 0");
    if (!set.noise_mm.empty() && set.noise_mm.size() != set.size())
        throw Error(ErrorKind::invalid_input,
                    std::to_string(set.size()) + " constraints have the noise of " + std::to_string(set.noise_mm.size()));
    for (const double value : set.noise_mm)
        if (!(value >= 0 && std::isfinite(value)))
            throw Error(ErrorKind::invalid_input,
                        "the noise of a constraint is " + std::to_string(value) + " mm; it must be finite and at least 0");
    return set;
}

/// A list with a number for each constraint, or an empty one, which stands for `otherwise`.
py::array_t<double> one_each(const ConstraintSet& set, std::vector<double> numbers, double otherwise) {
    if (numbers.empty()) numbers.resize(set.size(), otherwise);
    return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

}  // namespace

void bind_constraints(py::module_& m) {
    py::class_<ConstraintSet> set(m, "ConstraintSet", R"(Where the implicit function is prescribed, and its value there.

Parameters
----------
centers : array_like, shape (n, 3)
    mm (LPS).
values : array_like, shape (n,)
    mm: 0 on the surface, negative outside.
trust : array_like, shape (n,), optional
    > 0, the smoothing of a constraint is divided by it; 1 when left out.
noise_mm : array_like, shape (n,), optional
    >= 0, standard deviations of the values, beside smoothing; 0 when left out.
)");
    constructor(set, &constraints_from, py::arg("centers"), py::arg("values"), py::arg("trust") = py::none(),
                py::arg("noise_mm") = py::none());
    set.def_readonly("centers", &ConstraintSet::centers, "ndarray, shape (n, 3): mm.");
    set.def_property_readonly(
        "values",
        [](const ConstraintSet& s) { return py::array_t<double>(static_cast<py::ssize_t>(s.size()), s.values.data()); },
        "ndarray, shape (n,): mm.");
    set.def_property_readonly(
        "trust", [](const ConstraintSet& s) { return one_each(s, s.trust, 1); }, "ndarray, shape (n,)");
    set.def_property_readonly(
        "noise_mm", [](const ConstraintSet& s) { return one_each(s, s.noise_mm, 0); }, "ndarray, shape (n,): mm.");
    set.def("__len__", &ConstraintSet::size);
}

}  // namespace kontur::python
