// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/base/counted.h"
#include "kontur/shape/contour.h"

namespace kontur::python {
namespace {

void check_finite(const std::vector<Vec3>& points) {
    for (std::size_t n = 0; n < points.size(); ++n)
        if (!is_finite(points[n]))
            throw Error(ErrorKind::invalid_input, py::str("point {} of a contour is not finite: {}")
                                                      .format(n + 1, py::cast(points[n]).attr("tolist")())
                                                      .cast<std::string>());
}

Contour contour_from(std::vector<Vec3> points, const std::optional<Plane>& plane, bool closed, bool hole, ContourEnd end,
                     std::optional<Hand> inside, double weight, std::optional<double> frame, std::optional<double> time_s) {
    check_finite(points);
    const std::optional<Plane> its_plane = plane ? plane : fit_plane(points);
    if (!its_plane)
        throw Error(ErrorKind::invalid_input,
                    "a contour of " + std::to_string(points.size()) +
                        " points spans no plane; give it its plane, or at least 3 points off a line");
    Contour contour;
    contour.plane = *its_plane;
    contour.points = std::move(points);
    contour.closed = closed;
    contour.hole = hole;
    contour.end = end;
    contour.inside = inside;
    contour.weight = weight;
    contour.frame = frame;
    contour.time_s = time_s;
    return contour;
}

using SurfaceArgument = std::variant<std::vector<SurfacePoint>, ArrayOf<double>>;

/// Throws Error(invalid_input) for an array of another shape than (n, 3) and (n, 6).
std::vector<SurfacePoint> surface_points(const SurfaceArgument& given) {
    if (const auto* points = std::get_if<std::vector<SurfacePoint>>(&given)) return *points;
    const auto& array = std::get<ArrayOf<double>>(given);
    if (array.ndim() != 2 || (array.shape(1) != 3 && array.shape(1) != 6))
        throw Error(ErrorKind::invalid_input,
                    "surface: an array has the shape " + shape_text(array) + "; (n, 3) or (n, 6) is needed");
    std::vector<SurfacePoint> points;
    for (py::ssize_t n = 0; n < array.shape(0); ++n) {
        const double* row = array.data(n, 0);
        points.push_back({{row[0], row[1], row[2]}, {}});
        if (array.shape(1) == 6) points.back().outward = Vec3{row[3], row[4], row[5]};
    }
    return points;
}

bool equal(const Contour& a, const Contour& b) {
    return a.plane == b.plane && a.points == b.points && a.closed == b.closed && a.hole == b.hole && a.end == b.end &&
           a.inside == b.inside && a.weight == b.weight && a.frame == b.frame && a.time_s == b.time_s;
}

bool equal(const ContourSet& a, const ContourSet& b) {
    return a.name == b.name && a.interior == b.interior && a.exterior == b.exterior && a.surface == b.surface &&
           a.empty_planes == b.empty_planes && a.attributes == b.attributes && a.cycle_frames == b.cycle_frames &&
           a.cycle_s == b.cycle_s &&
           std::equal(a.contours.begin(), a.contours.end(), b.contours.begin(), b.contours.end(),
                      [](const Contour& x, const Contour& y) { return equal(x, y); });
}

py::array points_view(const py::object& self, const std::vector<Vec3>& points) {
    return read_only(
        array_view<double>(points.empty() ? nullptr : &points[0].x, {static_cast<py::ssize_t>(points.size()), 3}, self));
}

py::tuple contours_of(const py::object& self) {
    const auto& contours = self.cast<const ContourSet&>().contours;
    py::tuple all(contours.size());
    for (std::size_t n = 0; n < contours.size(); ++n)
        all[n] = py::cast(&contours[n], py::return_value_policy::reference_internal, self);
    return all;
}

py::object contour_at(const py::object& self, py::ssize_t index) {
    const auto& contours = self.cast<const ContourSet&>().contours;
    const auto count = static_cast<py::ssize_t>(contours.size());
    const py::ssize_t from_start = index < 0 ? index + count : index;
    if (from_start < 0 || from_start >= count)
        throw py::index_error("there is no contour " + std::to_string(index) + "; the set has " + std::to_string(count));
    return py::cast(&contours[static_cast<std::size_t>(from_start)], py::return_value_policy::reference_internal, self);
}

/// The set with these contours alone; all else stays.
ContourSet contours_at(const ContourSet& set, const py::slice& slice) {
    std::size_t start = 0, stop = 0, step = 0, count = 0;
    if (!slice.compute(set.contours.size(), &start, &stop, &step, &count)) throw py::error_already_set();
    ContourSet some{set.name,         {},         set.interior, set.exterior, set.surface, set.empty_planes, set.attributes,
                    set.cycle_frames, set.cycle_s};
    for (std::size_t n = 0; n < count; ++n, start += step) some.contours.push_back(set.contours[start]);
    return some;
}

bool holds(const ContourSet& set, const py::object& value) {
    if (!py::isinstance<Contour>(value)) return false;
    const auto& contour = value.cast<const Contour&>();
    return std::any_of(set.contours.begin(), set.contours.end(), [&](const Contour& c) { return equal(c, contour); });
}

Keywords<ContourCheckOptions> check_keywords() {
    return Keywords<ContourCheckOptions>()
        .field("plane_tolerance_mm", &ContourCheckOptions::plane_tolerance_mm, "Largest distance of a point from its plane.")
        .field("line_tolerance_mm", &ContourCheckOptions::line_tolerance_mm, "A contour no wider than this is a line.");
}

void bind_contour(py::module_& m) {
    py::class_<Contour> contour(
        m, "Contour", R"(One line drawn in a plane: a closed polygon, or an open stretch of the boundary. Immutable.

Parameters
----------
points : array_like, shape (n, 3)
    mm (LPS), in drawing order; the last point does not repeat the first. The orientation carries no meaning.
plane : Plane, optional
    Where it was drawn; fitted to the points when left out.
closed : bool
hole : bool
    True: the object lies outside of this contour (a cavity's wall); closed contours only.
end : {'automatic', 'flat', 'round'}
    How the object ends here, on the side where no other contour carries it on; closed contours only.
inside : {'left', 'right'}, optional
    Open contours only: where the object lies for someone who walks along the contour, upright on the side to which the plane's
    normal points; to be found out when left out.
weight : float
    How far it is trusted, against smoothness and the contours that it contradicts; from 0.001 to 1000.
frame, time_s : float, optional
    When it was drawn, of an object that moves: the image's frame, counted from 1, or seconds.

Examples
--------
>>> square = kontur.Contour([[0, 0, 5], [10, 0, 5], [10, 10, 5], [0, 10, 5]])
>>> square.points.shape, square.plane.normal.tolist()
((4, 3), [0.0, 0.0, 1.0])
)");
    constructor(contour, &contour_from, py::arg("points"), py::arg("plane") = py::none(), py::arg("closed") = true,
                py::arg("hole") = false, py::arg("end") = ContourEnd{}, py::arg("inside") = py::none(),
                py::arg("weight") = 1.0, py::arg("frame") = py::none(), py::arg("time_s") = py::none());
    contour.def_readonly("plane", &Contour::plane, "Plane: where it was drawn.");
    contour.def_property_readonly(
        "points", [](const py::object& self) { return points_view(self, self.cast<const Contour&>().points); },
        "ndarray, shape (n, 3), float64: mm (LPS); a read-only view.");
    contour.def_readonly("closed", &Contour::closed, "bool");
    contour.def_readonly("hole", &Contour::hole, "bool: the object lies outside of this contour.");
    contour.def_readonly("end", &Contour::end, "str: 'automatic', 'flat' or 'round'.");
    contour.def_readonly("inside", &Contour::inside, "str or None: 'left', 'right' or to be found out.");
    contour.def_readonly("weight", &Contour::weight, "float: how far it is trusted.");
    contour.def_readonly("frame", &Contour::frame, "float or None: of the image, from 1, in which it was drawn.");
    contour.def_readonly("time_s", &Contour::time_s, "float or None: when it was drawn.");
    contour.def("__len__", [](const Contour& c) { return c.points.size(); });
    contour.def(
        "__eq__", [](const Contour& a, const Contour& b) { return equal(a, b); }, py::is_operator());
    contour.def("__repr__", [](const Contour& c) {
        return py::str("<Contour of {}{}{}>")
            .format(counted(c.points.size(), "point"), c.closed ? "" : ", open", c.hole ? ", hole" : "");
    });
    picklable(contour, [](const Contour& c) {
        return py::make_tuple(c.points, c.plane, c.closed, c.hole, c.end, c.inside, c.weight, c.frame, c.time_s);
    });
}

void bind_surface_point(py::module_& m) {
    py::class_<SurfacePoint> point(m, "SurfacePoint", R"(A single point on the object's surface. Immutable.

Parameters
----------
position : array_like, shape (3,)
    mm (LPS).
outward : array_like, shape (3,), optional
    Unit, out of the object; only the position is known when left out.
)");
    constructor(
        point,
        [](const Vec3& position, const std::optional<Vec3>& outward) {
            return SurfacePoint{position, outward};
        },
        py::arg("position"), py::arg("outward") = py::none());
    point.def_readonly("position", &SurfacePoint::position, "ndarray, shape (3,), float64: mm.");
    point.def_readonly("outward", &SurfacePoint::outward, "ndarray, shape (3,), float64, or None.");
    point.def(
        "__eq__", [](const SurfacePoint& a, const SurfacePoint& b) { return a == b; }, py::is_operator());
    point.def("__repr__", [](const SurfacePoint& p) {
        return py::str("<SurfacePoint {}{}>")
            .format(py::cast(p.position).attr("tolist")(), p.outward ? ", outward known" : "");
    });
    picklable(point, [](const SurfacePoint& p) { return py::make_tuple(p.position, p.outward); });
}

void bind_contour_set(py::module_& m) {
    py::class_<ContourSet> set(m, "ContourSet", R"(Everything drawn for one object. Immutable.

A sequence of its contours; a slice is a set of some of them, with all else the same.

Parameters
----------
contours : sequence of Contour
name : str
    The structure's name.
interior, exterior : array_like, shape (n, 3), optional
    Points in mm that must lie inside, or outside, of the object.
surface : sequence of SurfacePoint or array_like, shape (n, 3) or (n, 6)
    Single points on the surface; six numbers are a position and a direction out of the object.
empty_planes : sequence of Plane
    Planes that were looked at, and in which nothing of the object is seen.
attributes : StructureAttributes, optional
    What files say of the object beside its name.
cycle_frames, cycle_s : float, optional
    The motion of contours with a frame, or a time, repeats after so many frames, or seconds.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> case.contours
<ContourSet 'kidney': 6 contours, 1500 points>
>>> case.contours[::2], len(case.contours[0])
(<ContourSet 'kidney': 3 contours, 751 points>, 244)
)");
    constructor(
        set,
        [](std::vector<Contour> contours, std::string name, const std::optional<std::vector<Vec3>>& interior,
           const std::optional<std::vector<Vec3>>& exterior, const SurfaceArgument& surface, std::vector<Plane> empty_planes,
           std::optional<StructureAttributes> attributes, std::optional<double> cycle_frames,
           std::optional<double> cycle_s) {
            return ContourSet{std::move(name),
                              std::move(contours),
                              interior.value_or(std::vector<Vec3>{}),
                              exterior.value_or(std::vector<Vec3>{}),
                              surface_points(surface),
                              std::move(empty_planes),
                              std::move(attributes).value_or(StructureAttributes{}),
                              cycle_frames,
                              cycle_s};
        },
        py::arg("contours"), py::arg("name") = "", py::arg("interior") = py::none(), py::arg("exterior") = py::none(),
        py::arg("surface") = py::tuple(), py::arg("empty_planes") = py::tuple(), py::arg("attributes") = py::none(),
        py::arg("cycle_frames") = py::none(), py::arg("cycle_s") = py::none());
    set.def_property_readonly("contours", &contours_of, "tuple of Contour");
    set.def_readonly("name", &ContourSet::name, "str: may be empty.");
    set.def_readonly("interior", &ContourSet::interior, "ndarray, shape (n, 3), float64: mm.");
    set.def_readonly("exterior", &ContourSet::exterior, "ndarray, shape (n, 3), float64: mm.");
    set.def_readonly("surface", &ContourSet::surface, "list of SurfacePoint");
    set.def_readonly("empty_planes", &ContourSet::empty_planes, "list of Plane: in which nothing of the object is seen.");
    set.def_readonly("attributes", &ContourSet::attributes, "StructureAttributes: what files say of the object.");
    set.def_readonly("cycle_frames", &ContourSet::cycle_frames, "float or None: after which the motion repeats.");
    set.def_readonly("cycle_s", &ContourSet::cycle_s, "float or None: after which the motion repeats.");
    set.def_property_readonly("point_count", &point_count, "int: over all contours.");
    set.def_property_readonly(
        "bounding_box", [](const ContourSet& s) { return bounding_box(s); },
        "ndarray, shape (2, 3), float64: lowest and highest coordinates of all contour points, mm.");
    set.def_property_readonly(
        "smallest_ball", [](const ContourSet& s) { return smallest_ball(s); },
        "tuple of an ndarray of shape (3,) and a float: centre and radius of the smallest ball around all points, mm.");
    set.def_property_readonly("diameter_mm", &diameter_mm,
                              "float: diameter of that ball, which the method's lengths are fractions of.");
    set.def("__len__", [](const ContourSet& s) { return s.contours.size(); });
    set.def("__iter__", [](const py::object& self) { return py::iter(contours_of(self)); });
    set.def("__contains__", &holds);
    set.def("__getitem__", &contour_at);
    set.def("__getitem__", &contours_at);
    set.def(
        "__eq__", [](const ContourSet& a, const ContourSet& b) { return equal(a, b); }, py::is_operator());
    set.def("__repr__", [](const ContourSet& s) {
        return py::str("<ContourSet {!r}: {}, {}>")
            .format(s.name, counted(s.contours.size(), "contour"), counted(point_count(s), "point"));
    });
    picklable(set, [](const ContourSet& s) {
        return py::make_tuple(s.contours, s.name, s.interior, s.exterior, s.surface, s.empty_planes, s.attributes,
                              s.cycle_frames, s.cycle_s);
    });
}

}  // namespace

void bind_contours(py::module_& m) {
    bind_surface_point(m);
    bind_contour(m);
    bind_contour_set(m);

    define(
        m, "without_duplicate_points", R"(The contours without points that repeat the one before them exactly.)",
        [](ContourSet contours) {
            drop_duplicate_points(contours);
            return contours;
        },
        py::arg("contours"));
    const auto checks = check_keywords();
    define(
        m, "check_contours",
        R"(Raises InvalidInputError, naming the contour and the limit, when the contours cannot be segmented.

Parameters
----------
contours : ContourSet
@options
)",
        [checks](const ContourSet& contours, const py::kwargs& options) {
            check_contours(contours, checks.parse("check_contours", options));
        },
        py::arg("contours"), py::kw_only(), KeywordText(checks));
    define(
        m, "without_lines",
        R"(The contours without closed ones whose points lie on one line, which enclose nothing, as `segment` takes them.

Where no other contour shows the object, they stay.

Parameters
----------
contours : ContourSet
    As `check_contours` accepts them.
@options

Returns
-------
ContourSet

Examples
--------
>>> plane = kontur.Plane([0, 0, 0], [0, 0, 1])
>>> square = kontur.Contour([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], plane)
>>> line = kontur.Contour([[20, 0, 0], [29, 0, 0], [25, 0, 0]], plane)
>>> len(kontur.without_lines(kontur.ContourSet([square, line])).contours)
1
)",
        [checks](ContourSet contours, const py::kwargs& options) {
            leave_out_lines(contours, checks.parse("without_lines", options));
            return contours;
        },
        py::arg("contours"), py::kw_only(), KeywordText(checks));
    define(
        m, "contour_problems", R"(Every reason to refuse the contours, one sentence each; empty when they can be segmented.

Parameters
----------
contours : ContourSet
@options

Returns
-------
list of str

Examples
--------
>>> kontur.contour_problems(kontur.ContourSet([]))
['there is no contour; at least 1 is needed']
)",
        [checks](const ContourSet& contours, const py::kwargs& options) {
            return contour_problems(contours, checks.parse("contour_problems", options));
        },
        py::arg("contours"), py::kw_only(), KeywordText(checks));
    define(m, "points_outside", "Number of contour points outside of the grid's voxels.", &points_outside,
           py::arg("contours"), py::arg("grid"));
    define(
        m, "check_contours_inside",
        "Raises InvalidInputError when the contours' box does not reach into the grid; a warning sentence when points lie "
        "outside, else None.",
        &check_contours_inside, py::arg("contours"), py::arg("grid"));
}

}  // namespace kontur::python
