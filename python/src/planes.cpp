// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

namespace kontur::python {
namespace {

bool is_orthonormal(const Plane& plane) {
    constexpr double kTolerance = 1e-6;
    const auto differ = [](double a, double b) { return !(std::abs(a - b) <= kTolerance); };
    return !(differ(norm(plane.u), 1) || differ(norm(plane.v), 1) || differ(norm(plane.normal), 1) ||
             differ(dot(plane.u, plane.v), 0) || differ(dot(plane.u, plane.normal), 0) ||
             differ(dot(plane.v, plane.normal), 0));
}

Plane plane_from(const Vec3& origin, const Vec3& normal, const std::optional<Vec3>& u, const std::optional<Vec3>& v) {
    if (!(is_finite(origin) && is_finite(normal) && norm(normal) > 0))
        throw Error(ErrorKind::invalid_input, "a plane needs a finite origin and a normal that is not 0");
    if (u.has_value() != v.has_value()) throw Error(ErrorKind::invalid_input, "u and v are given together or not at all");
    if (!u) return make_plane(origin, normal);
    const Plane plane{origin, normal, *u, *v};
    if (!is_orthonormal(plane)) throw Error(ErrorKind::invalid_input, "a plane's normal, u and v are not orthonormal");
    return plane;
}

}  // namespace

void bind_planes(py::module_& m) {
    py::class_<Plane> plane(m, "Plane", R"(A plane with an orthonormal frame, in mm (LPS). Immutable.

Parameters
----------
origin : array_like, shape (3,)
    A point of the plane, mm.
normal : array_like, shape (3,)
    Of any length > 0; a unit vector when `u` and `v` are given.
u, v : array_like, shape (3,), optional
    Orthonormal axes in the plane; chosen for you when left out.

Examples
--------
>>> kontur.Plane([0, 0, 5], [0, 0, 2]).distance_to([[1, 2, 8]])
array([3.])
)");
    constructor(plane, &plane_from, py::arg("origin"), py::arg("normal"), py::arg("u") = py::none(),
                py::arg("v") = py::none());
    plane.def_readonly("origin", &Plane::origin, "ndarray, shape (3,), float64: mm.");
    plane.def_readonly("normal", &Plane::normal, "ndarray, shape (3,), float64: unit.");
    plane.def_readonly("u", &Plane::u, "ndarray, shape (3,), float64: unit.");
    plane.def_readonly("v", &Plane::v, "ndarray, shape (3,), float64: unit.");
    method(
        plane, "distance_to",
        "Signed distances in mm of points, shape (n, 3): ndarray, shape (n,), > 0 on the normal's side.",
        [](const Plane& self, const ArrayOf<double>& points) {
            std::vector<double> distances;
            for (const Vec3& p : points_of(points)) distances.push_back(self.distance_to(p));
            const auto count = static_cast<py::ssize_t>(distances.size());
            return owning_array(std::move(distances), {count});
        },
        py::arg("points"));
    method(
        plane, "to_uv", "In-plane coordinates in mm of the projections of points, shape (n, 3): ndarray, shape (n, 2).",
        [](const Plane& self, const ArrayOf<double>& points) {
            std::vector<std::array<double, 2>> all;
            for (const Vec3& p : points_of(points)) all.push_back(self.to_uv(p));
            const auto count = static_cast<py::ssize_t>(all.size());
            return owning_array<std::array<double, 2>, double>(std::move(all), {count, 2});
        },
        py::arg("points"));
    method(
        plane, "from_uv", "Points of the plane, ndarray of shape (n, 3) in mm, from in-plane coordinates, shape (n, 2).",
        [](const Plane& self, const ArrayOf<double>& uv) {
            if (uv.size() != 0 && (uv.ndim() != 2 || uv.shape(1) != 2))
                throw Error(ErrorKind::invalid_input,
                            "in-plane coordinates have the shape " + shape_text(uv) + "; (n, 2) is needed");
            std::vector<Vec3> points;
            for (py::ssize_t n = 0; n < uv.size() / 2; ++n) points.push_back(self.from_uv(uv.at(n, 0), uv.at(n, 1)));
            return points;
        },
        py::arg("uv"));
    plane.def(
        "__eq__", [](const Plane& a, const Plane& b) { return a == b; }, py::is_operator());
    plane.def("__repr__", [](const Plane& p) {
        return py::str("Plane(origin={}, normal={})")
            .format(py::cast(p.origin).attr("tolist")(), py::cast(p.normal).attr("tolist")());
    });
    picklable(plane, [](const Plane& p) { return py::make_tuple(p.origin, p.normal, p.u, p.v); });

    define(
        m, "fit_plane", R"(The least-squares plane through points, shape (n, 3), mm; None when they span none.)",
        [](const ArrayOf<double>& points) { return fit_plane(points_of(points)); }, py::arg("points"));
}

}  // namespace kontur::python
