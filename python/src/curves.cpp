// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "bindings.h"
#include "fields.h"
#include "kontur/shape/apply_fill_rule.h"
#include "kontur/shape/contour_nesting.h"
#include "kontur/shape/fill_rule.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/self_intersections.h"
#include "kontur/shape/spline.h"
#include "segment_words.h"

// Lines in planes by themselves: curves through points, what lies inside what, where a line meets itself.

namespace kontur::python {
namespace {

Polygon2 polygon_from(const ArrayOf<double>& points) {
    if (points.ndim() != 2 || points.shape(1) != 2)
        throw Error(ErrorKind::invalid_input, "a polygon has the shape " + shape_text(points) + "; (n, 2) is needed");
    const auto* first = reinterpret_cast<const Point2*>(points.data());
    static_assert(sizeof(Point2) == 2 * sizeof(double));
    Polygon2 polygon(first, first + points.shape(0));
    if (!std::all_of(points.data(), points.data() + points.size(), [](double x) { return std::isfinite(x); }))
        throw Error(ErrorKind::invalid_input, "a coordinate of the polygon is NaN or infinite");
    for (std::size_t n = 0; n < polygon.size(); ++n)
        if (polygon[n] == polygon[(n + 1) % polygon.size()])
            throw Error(ErrorKind::invalid_input,
                        "point " + std::to_string(n) + " of the polygon is repeated by the next one");
    if (polygon.size() < 3)
        throw Error(ErrorKind::invalid_input,
                    "a polygon of " + std::to_string(polygon.size()) + " points; at least 3 are needed");
    return polygon;
}

std::string word(SelfIntersection::Kind kind) {
    constexpr std::array<const char*, 3> kWords{"crossing", "touch", "fold"};
    return kWords[static_cast<std::size_t>(kind)];
}

void bind_types(py::module_& m, py::module_& stages) {
    py::class_<Nesting> nesting(stages, "Nesting", "Which closed contours of a plane lie inside others.");
    nesting.def_readonly("depth", &Nesting::depth, "list of int: per contour, how many others enclose it.");
    nesting.def_readonly("enclosing", &Nesting::enclosing, "list of list of int: per contour, which ones.");
    nesting.def_readonly("crossings", &Nesting::crossings, "list of (int, int): pairs that overlap in part.");

    py::class_<NearLines> near(m, "NearLines",
                               "Two closed contours of one plane so near to each other that they may be one, drawn twice.");
    Fields(near)
        .field("contour", &NearLines::contour, "int: index of the contour inside the other, or of the first that cross.")
        .field("other", &NearLines::other, "int: index of the other one.")
        .field("apart_mm", &NearLines::apart_mm, "float: on average.")
        .field("share", &NearLines::share, "float: what lies between them, of what the larger one encloses.")
        .field("are_nested", &NearLines::are_nested, "bool: whether one lies inside the other.")
        .field("is_one", &NearLines::is_one, "bool: taken for one line; otherwise the inner one is a hole.")
        .picklable();

    py::class_<FillChanges> changes(stages, "FillChanges", "What `apply_fill_rule` did.");
    changes.def_readonly("holes", &FillChanges::holes, "int: contours that became holes.");
    changes.def_readonly("removed", &FillChanges::removed, "int: contours taken out.");
    changes.def_readonly("crossings", &FillChanges::crossings, "list of (int, int): pairs that overlap in part.");
    changes.def_readonly("near_lines", &FillChanges::near_lines,
                         "list of NearLines: taken for one line, or a hole that leaves a thin wall; indices of the result.");

    py::class_<SelfIntersection> contact(stages, "SelfIntersection", "A place where two parts of a closed polygon meet.");
    contact.def_property_readonly(
        "kind", [](const SelfIntersection& c) { return word(c.kind); }, "str: 'crossing', 'touch' or 'fold'.");
    contact.def_property_readonly(
        "position", [](const SelfIntersection& c) { return py::array_t<double>(2, c.position.data()); },
        "ndarray, shape (2,), float64");
    contact.def_readonly("first", &SelfIntersection::first, "int: the segment from point `first` to the next.");
    contact.def_readonly("second", &SelfIntersection::second, "int: likewise, larger.");
}

}  // namespace

void bind_curves(py::module_& m, py::module_& stages) {
    bind_types(m, stages);
    define(
        stages, "spline", R"(The centripetal Catmull-Rom curve through points.

Parameters
----------
points : array_like, shape (n, 3)
    mm; fewer than 3 are returned as they are.
closed : bool
step_mm : float
    About the distance from point to point of the result.

Returns
-------
ndarray, shape (m, 3), float64
    Planar when the points are; a closed curve does not repeat its first point.

Examples
--------
>>> square = [[0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]]
>>> rounded = kontur.Contour(kontur.stages.spline(square, closed=True, step_mm=0.5))
>>> len(rounded) > 60
True
)",
        [](const std::vector<Vec3>& points, bool closed, double step_mm) {
            return unlocked([&] { return spline(points, closed, step_mm); });
        },
        py::arg("points"), py::arg("closed"), py::arg("step_mm"));
    define(
        stages, "find_nesting", R"(Which closed contours of a plane lie inside others.

Parameters
----------
contours : ContourSet
tolerance_mm : float
    Closer planes are one; closer points count as neither inside nor outside.

Returns
-------
Nesting
)",
        [](const ContourSet& set, double tolerance_mm) {
            return unlocked([&] { return find_nesting(set.contours, tolerance_mm); });
        },
        py::arg("contours"), py::arg("tolerance_mm"));
    define(
        stages, "apply_fill_rule", R"(Makes each contour's `hole` say on which of its sides the object lies.

Parameters
----------
contours : ContourSet
fill_rule : {'even-odd', 'declared'}
    A contour inside an odd number of others is a hole; or only those declared to be one are, and others inside the object are
    taken out.

Returns
-------
(ContourSet, FillChanges)

Examples
--------
>>> ring = [kontur.Contour(r * np.array([[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])) for r in (10, 5)]
>>> filled, changes = kontur.stages.apply_fill_rule(kontur.ContourSet(ring))
>>> [contour.hole for contour in filled.contours], changes.holes
([False, True], 1)
)",
        [](ContourSet set, FillRule rule) {
            FillChanges changes = unlocked([&] { return apply_fill_rule(set, rule); });
            return py::make_tuple(std::move(set), std::move(changes));
        },
        py::arg("contours"), py::arg("fill_rule") = FillRule{});
    define(
        stages, "find_self_intersections", R"(All places where a closed polygon meets itself, decided exactly.

Parameters
----------
points : array_like, shape (n, 2)
    Any unit; `Plane.to_uv` gives those of a contour. No point may repeat the one before it.

Returns
-------
list of SelfIntersection

Examples
--------
>>> [contact] = kontur.stages.find_self_intersections([[0, 0], [10, 10], [10, 0], [0, 10]])
>>> contact.kind, contact.position.tolist()
('crossing', [5.0, 5.0])
)",
        [](const ArrayOf<double>& points) {
            const Polygon2 polygon = polygon_from(points);
            return unlocked([&] { return find_self_intersections(polygon).places; });
        },
        py::arg("points"));
}

}  // namespace kontur::python
