// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/crossings.h"
#include "bindings.h"

namespace kontur::python {

void bind_crossings(py::module_& m) {
    py::class_<Crossing> crossing(m, "Crossing", "A place where a contour passes through the plane of another one.");
    crossing.def_readonly("contour", &Crossing::contour, "int: index of the contour that passes through the plane of");
    crossing.def_readonly("other", &Crossing::other, "int: this one.");
    crossing.def_readonly("position", &Crossing::position,
                          "ndarray, shape (3,): mm, where `contour` passes the common line.");
    crossing.def_readonly("other_position", &Crossing::other_position, "ndarray, shape (3,): mm, where `other` passes it.");
    crossing.def_readonly("matched", &Crossing::matched, "bool: False where the other plane shows nothing.");
    crossing.def_readonly("distance_mm", &Crossing::distance_mm, "float: > 0 where `contour` passes outside of `other`.");
    crossing.def_readonly("disagreement_mm", &Crossing::disagreement_mm,
                          "float: how far a surface would have to move so that both are right.");
    crossing.def("__str__", [](const Crossing& self) { return sentence(self); });

    py::class_<Disagreement> type(m, "Disagreement", "How well contours agree where they cross, over matched crossings.");
    type.def_readonly("matched", &Disagreement::matched, "int");
    type.def_readonly("unmatched", &Disagreement::unmatched, "int");
    type.def_readonly("mean_mm", &Disagreement::mean_mm, "float");
    type.def_readonly("rms_mm", &Disagreement::rms_mm, "float");
    type.def_readonly("max_mm", &Disagreement::max_mm, "float");
    type.def_readonly("max_unmatched_mm", &Disagreement::max_unmatched_mm, "float");

    define(
        m, "find_crossings", R"(Every place where closed contours of different planes meet: list of Crossing.

Examples
--------
>>> crossings = kontur.find_crossings(kontur.phantom_case("liver_orthogonal14").contours)
>>> kontur.disagreement(crossings).max_mm < 0.1
True
)",
        [](const ContourSet& contours) { return unlocked([&] { return find_crossings(contours); }); }, py::arg("contours"));
    define(
        m, "disagreement", "The Disagreement over a list of Crossing.",
        [](const std::vector<Crossing>& crossings) { return disagreement(crossings); }, py::arg("crossings"));
    define(
        m, "disagreement_by_contour",
        "The same for each contour, over the crossings that it takes part in: list of Disagreement.",
        [](const std::vector<Crossing>& crossings, std::size_t contour_count) {
            return disagreement_by_contour(crossings, contour_count);
        },
        py::arg("crossings"), py::arg("contour_count"));
}

}  // namespace kontur::python
