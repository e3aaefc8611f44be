// SPDX-License-Identifier: Apache-2.0
#include "kontur/shape/crossings.h"
#include "bindings.h"
#include "fields.h"

namespace kontur::python {

void bind_crossings(py::module_& m, py::module_& stages) {
    py::class_<Crossing> crossing(m, "Crossing", "A place where a contour passes through the plane of another one.");
    Fields(crossing)
        .field("contour", &Crossing::contour, "int: index of the contour that passes through the plane of")
        .field("other", &Crossing::other, "int: this one.")
        .field("position", &Crossing::position, "ndarray, shape (3,): mm, where `contour` passes the common line.")
        .field("other_position", &Crossing::other_position, "ndarray, shape (3,): mm, where `other` passes it.")
        .field("matched", &Crossing::matched, "bool: False where the other plane shows nothing.")
        .field("distance_mm", &Crossing::distance_mm, "float: > 0 where `contour` passes outside of `other`.")
        .field("disagreement_mm", &Crossing::disagreement_mm,
               "float: how far a surface would have to move so that both are right.")
        .picklable();
    crossing.def("__str__", [](const Crossing& self) { return sentence(self); });
    crossing.def("__repr__", [](const Crossing& self) {
        return py::str("<Crossing of contours[{}] and [{}], {:.3g} mm{}>")
            .format(self.contour, self.other, self.disagreement_mm, self.matched ? "" : ", unmatched");
    });

    py::class_<Disagreement> type(m, "Disagreement", "How well contours agree where they cross, over matched crossings.");
    Fields(type)
        .field("matched", &Disagreement::matched, "int")
        .field("unmatched", &Disagreement::unmatched, "int")
        .field("mean_mm", &Disagreement::mean_mm, "float")
        .field("rms_mm", &Disagreement::rms_mm, "float")
        .field("max_mm", &Disagreement::max_mm, "float")
        .field("max_unmatched_mm", &Disagreement::max_unmatched_mm, "float")
        .picklable();
    type.def("__repr__", [](const Disagreement& d) {
        return py::str("<Disagreement: max {:.3g} mm, rms {:.3g} mm, {} matched, {} not>")
            .format(d.max_mm, d.rms_mm, d.matched, d.unmatched);
    });

    define(
        stages, "find_crossings", R"(Every place where closed contours of different planes meet: list of Crossing.

Examples
--------
>>> crossings = kontur.stages.find_crossings(kontur.phantom_case("liver_orthogonal14").contours)
>>> kontur.stages.disagreement(crossings).max_mm < 0.1
True
)",
        [](const ContourSet& contours) { return unlocked([&] { return find_crossings(contours); }); }, py::arg("contours"));
    define(
        stages, "disagreement", "The Disagreement over a list of Crossing.",
        [](const std::vector<Crossing>& crossings) { return disagreement(crossings); }, py::arg("crossings"));
    define(
        stages, "disagreement_by_contour",
        "The same for each contour, over the crossings that it takes part in: list of Disagreement.",
        [](const std::vector<Crossing>& crossings, std::size_t contour_count) {
            return disagreement_by_contour(crossings, contour_count);
        },
        py::arg("crossings"), py::arg("contour_count"));
}

}  // namespace kontur::python
