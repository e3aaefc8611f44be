// SPDX-License-Identifier: Apache-2.0
#include "kontur/field/constraints.h"

#include <cmath>

#include "bindings.h"
#include "kontur/field/prepare.h"
#include "points.h"

namespace kontur::python {
namespace {

ConstraintSet constraints_from(std::vector<Vec3> centers, const ArrayOf<double>& values,
                               std::optional<std::vector<ConstraintKind>> kinds, const std::optional<ArrayOf<double>>& trust,
                               const std::optional<ArrayOf<double>>& noise_mm) {
    ConstraintSet set;
    set.centers = std::move(centers);
    set.values = list_of(values, "values");
    set.kinds = kinds ? std::move(*kinds) : std::vector<ConstraintKind>(set.size(), ConstraintKind::boundary);
    if (trust) set.trust = list_of(*trust, "trust");
    if (noise_mm) set.noise_mm = list_of(*noise_mm, "noise_mm");
    if (set.values.size() != set.size() || set.kinds.size() != set.size())
        throw Error(ErrorKind::invalid_input, std::to_string(set.size()) + " constraints have " +
                                                  std::to_string(set.values.size()) + " values and " +
                                                  std::to_string(set.kinds.size()) + " kinds");
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

PlacedConstraints place(const PreparedContours& prepared, const std::vector<double>& slopes, const PlaceOptions& options) {
    if (slopes.size() != prepared.points.size())
        throw Error(ErrorKind::invalid_input,
                    std::to_string(prepared.points.size()) + " points have " + std::to_string(slopes.size()) + " slopes");
    for (const double slope : slopes)
        if (!(slope > 0 && slope <= 1))
            throw Error(ErrorKind::invalid_input,
                        "a slope is " + std::to_string(slope) + "; it must be above 0 and at most 1");
    return place_constraints(prepared.points, slopes, {}, options);
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
kinds : sequence of {'boundary', 'normal', 'interior', 'exterior', 'bound'}, optional
    'boundary' when left out.
trust : array_like, shape (n,), optional
    > 0, the smoothing of a constraint is divided by it; 1 when left out.
noise_mm : array_like, shape (n,), optional
    >= 0, standard deviations of the values, beside smoothing; 0 when left out.
)");
    constructor(set, &constraints_from, py::arg("centers"), py::arg("values"), py::arg("kinds") = py::none(),
                py::arg("trust") = py::none(), py::arg("noise_mm") = py::none());
    set.def_readonly("centers", &ConstraintSet::centers, "ndarray, shape (n, 3): mm.");
    set.def_property_readonly(
        "values",
        [](const ConstraintSet& s) { return py::array_t<double>(static_cast<py::ssize_t>(s.size()), s.values.data()); },
        "ndarray, shape (n,): mm.");
    set.def_readonly("kinds", &ConstraintSet::kinds, "list of str");
    set.def_property_readonly(
        "trust", [](const ConstraintSet& s) { return one_each(s, s.trust, 1); }, "ndarray, shape (n,)");
    set.def_property_readonly(
        "noise_mm", [](const ConstraintSet& s) { return one_each(s, s.noise_mm, 0); }, "ndarray, shape (n,): mm.");
    set.def("__len__", &ConstraintSet::size);

    py::class_<PlacedConstraints> placed(m, "PlacedConstraints", "Constraints at prepared contours.");
    placed.def_readonly("constraints", &PlacedConstraints::constraints, "ConstraintSet");
    placed.def_readonly("merged", &PlacedConstraints::merged, "int: left out because they nearly repeat others.");
    const auto keywords =
        Keywords<PlaceOptions>()
            .field("normal_offset_mm", &PlaceOptions::normal_offset_mm, "Length of the normal constraints.")
            .field("merge_distance_mm", &PlaceOptions::merge_distance_mm,
                   "A constraint closer than this to an earlier one is left out.");
    define(
        m, "place_constraints", R"(Boundary constraints at all prepared points, and a normal constraint outside of each.

What `fit` solves in each of its rounds, without bounds.

Parameters
----------
prepared : PreparedContours
slopes : array_like, shape (n,), optional
    In (0, 1]: how fast f falls along each point's in-plane normal, the cosine of the surface's tilt; 1, the paper's choice, when
    left out.
@options

Returns
-------
PlacedConstraints

Examples
--------
>>> prepared = kontur.prepare(kontur.phantom_case("kidney_radial6").contours)
>>> placed = kontur.place_constraints(prepared, normal_offset_mm=0.5)
>>> len(placed.constraints) + placed.merged == 2 * len(prepared.positions)
True
)",
        [keywords](const PreparedContours& prepared, const std::optional<ArrayOf<double>>& given_slopes,
                   const py::kwargs& given) {
            const PlaceOptions options = keywords.parse("place_constraints", given);
            const std::vector<double> slopes =
                given_slopes ? list_of(*given_slopes, "slopes") : std::vector<double>(prepared.points.size(), 1.0);
            return unlocked([&] { return place(prepared, slopes, options); });
        },
        py::arg("prepared"), py::arg("slopes") = py::none(), py::kw_only(), KeywordText(keywords));
}

}  // namespace kontur::python
