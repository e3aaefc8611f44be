// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "bindings.h"
#include "fields.h"
#include "kontur/base/counted.h"
#include "kontur/base/error.h"
#include "kontur/drawing_check.h"
#include "kontur/pipeline.h"
#include "segment_words.h"

namespace kontur::python {
namespace {

void bind_plane_checks(py::module_& m) {
    py::class_<WrongRegion> region(m, "WrongRegion",
                                   "A connected part of a drawn plane on which the result is on the other side than the "
                                   "drawing.");
    Fields(region)
        .field("position", &WrongRegion::position, "ndarray, shape (3,): mm, its place farthest from the plane's lines.")
        .field("area_mm2", &WrongRegion::area_mm2, "float: of what is deeper than the check's tolerance.")
        .field("depth_mm", &WrongRegion::depth_mm, "float: of the position, to the nearest line of the plane.")
        .field("is_missing", &WrongRegion::is_missing, "bool: drawn, and not in the result; else the other way round.")
        .field("is_island", &WrongRegion::is_island, "bool: not drawn, and apart from all that is drawn in the plane.")
        .field("is_lost", &WrongRegion::is_lost, "bool: a whole region of the drawing of which nothing is in the result.")
        .field("is_explained", &WrongRegion::is_explained, "bool: planes contradict each other there.")
        .picklable();
    py::class_<PlaneCheck> plane(m, "PlaneCheck", "A drawn plane against the result's section with it.");
    Fields(plane)
        .field("plane", &PlaneCheck::plane, "Plane")
        .field("contour", &PlaneCheck::contour, "int: index of the first contour in it; None: a plane given as empty.")
        .field("area_mm2", &PlaneCheck::area_mm2, "float: of what is drawn; of an empty plane the mean of all drawn ones.")
        .field("wrong_share", &PlaneCheck::wrong_share, "float: of this area: regions that no contradiction explains.")
        .field("island_share", &PlaneCheck::island_share, "float: the same of islands alone.")
        .field("regions", &PlaneCheck::regions, "list of WrongRegion: largest first, explained ones included.")
        .field("is_wrong", &PlaneCheck::is_wrong, "bool: more than an unsteady hand makes.")
        .picklable();
}

void bind_way_checks(py::module_& m) {
    py::class_<BetweenCheck> between(m, "BetweenCheck", "Two planes of which each shows the object across from the other.");
    Fields(between)
        .field("contour", &BetweenCheck::contour, "int: index of the first contour in the one plane.")
        .field("other", &BetweenCheck::other, "int: index of the first contour in the other plane.")
        .field("missing_share", &BetweenCheck::missing_share,
               "float: of the ways between them, those that leave the result.")
        .field("gap_mm", &BetweenCheck::gap_mm, "float: median length of these ways.")
        .field("position", &BetweenCheck::position, "ndarray, shape (3,): mm, in the middle of one of them.")
        .field("is_wrong", &BetweenCheck::is_wrong, "bool")
        .picklable();
    py::class_<BeyondCheck> beyond(m, "BeyondCheck", "The result beyond a last plane.");
    Fields(beyond)
        .field("contour", &BeyondCheck::contour, "int: index of the first contour in the plane.")
        .field("length_mm", &BeyondCheck::length_mm, "float: by which it goes on there, mean over the section.")
        .field("gap_mm", &BeyondCheck::gap_mm, "float: to the plane before, or what other planes reach beyond.")
        .field("is_flat", &BeyondCheck::is_flat, "bool: the drawing says that the object ends in the plane.")
        .field("position", &BeyondCheck::position, "ndarray, shape (3,): mm, on the end.")
        .field("is_wrong", &BeyondCheck::is_wrong, "bool")
        .picklable();
}

/// Values by a call from the calling thread, which is where check_sections asks.
PlaceValues called(const py::object& function) {
    return [function](std::span<const Vec3> places, std::span<double> values) {
        py::array_t<double> points({static_cast<py::ssize_t>(places.size()), py::ssize_t{3}});
        double* next = points.mutable_data();
        for (const Vec3& p : places)
            for (int axis = 0; axis < 3; ++axis) *next++ = p[axis];
        const auto found = function(points).cast<py::array_t<double, py::array::c_style | py::array::forcecast>>();
        if (found.size() != points.shape(0))
            throw Error(ErrorKind::invalid_input,
                        fmt::format("the function gave {} values for {} points; it takes one for each", found.size(),
                                    points.shape(0)));
        std::copy_n(found.data(), values.size(), values.begin());
    };
}

}  // namespace

void bind_section_checks(py::module_& m) {
    bind_plane_checks(m);
    bind_way_checks(m);
    py::class_<SectionCheck> type(m, "SectionCheck", "A result against what was drawn.");
    Fields(type)
        .field("planes", &SectionCheck::planes, "list of PlaneCheck")
        .field("between", &SectionCheck::between, "list of BetweenCheck: where something is missing between two planes.")
        .field("beyond", &SectionCheck::beyond, "list of BeyondCheck: where the result goes on beyond a last plane.")
        .field("outside_share", &SectionCheck::outside_share,
               "float: of the result, what lies far outside of the ball around all that was drawn.")
        .field("outside_position", &SectionCheck::outside_position, "ndarray, shape (3,): mm, the farthest place of that.")
        .field("is_outside_wrong", &SectionCheck::is_outside_wrong, "bool")
        .picklable();
    type.def_property_readonly(
        "sentences", [](const SectionCheck& check) { return sentences(check); },
        "list of str: one for each kind of fault, contours counted from 1.");
    type.def_property_readonly("largest_wrong_share", &SectionCheck::largest_wrong_share, "float: of any plane.");
    type.def("__repr__", [](const SectionCheck& check) {
        return py::str("<SectionCheck: {} of {} planes wrong, {} in all>")
            .format(check.wrong_planes(), check.planes.size(), counted(sentences(check).size(), "sentence"));
    });
    define(
        m, "check_sections", R"(Compares a result with its own drawing: in, between and beyond the drawn planes.

`segment` does this itself: `report.section_check`. In each drawn plane regions count that are deeper than 0.45 % of the
drawing's diameter and that no contradiction between planes explains.

Parameters
----------
contours : ContourSet
function : ImplicitFunction, or callable
    A callable gets points, ndarray of shape (n, 3) in mm, and gives n values, above 0 inside.
fill_rule : {'even-odd', 'declared'}
@threads

Returns
-------
SectionCheck

Raises
------
InvalidInputError
    For contours that `check_contours` refuses.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> made = kontur.segment(case.contours, case.grid)
>>> kontur.check_sections(case.contours, made.function).sentences
[]
)",
        [](const ContourSet& contours, const py::object& function, FillRule rule, int threads) {
            if (py::isinstance<ImplicitFunction>(function)) {
                const auto& fitted = function.cast<const ImplicitFunction&>();
                return unlocked([&] { return check_sections(read_drawing(contours, rule), fitted, {.threads = threads}); });
            }
            return check_sections(read_drawing(contours, rule), called(function), {}, {.threads = threads});
        },
        py::arg("contours"), py::arg("function"), py::arg("fill_rule") = FillRule::even_odd, kThreads);
}

}  // namespace kontur::python
