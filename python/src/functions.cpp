// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "fields.h"
#include "kontur/fit/residual.h"
#include "kontur/function/implicit_function.h"
#include "points.h"

namespace kontur::python {
namespace {

PointArrays point_arrays(const std::vector<Vec3>& points) { return PointArrays(points); }

std::vector<Vec3> points_of_function(const ImplicitFunction& function) {
    const PointArrays& centers = function.centers();
    std::vector<Vec3> points(centers.size());
    for (std::size_t n = 0; n < points.size(); ++n) points[n] = centers[n];
    return points;
}

ImplicitFunction function_from(Kernel kernel, const Vec3& frame_center_mm, double frame_scale_mm,
                               const std::vector<Vec3>& centers, const ArrayOf<double>& weight_array,
                               const ArrayOf<double>& polynomial) {
    const std::vector<double> weights = list_of(weight_array, "weights"), p = list_of(polynomial, "the polynomial");
    if (p.size() != 4)
        throw Error(ErrorKind::invalid_input, "the polynomial has " + std::to_string(p.size()) + " numbers; 4 are needed");
    if (centers.size() != weights.size())
        throw Error(ErrorKind::invalid_input,
                    std::to_string(centers.size()) + " centres have " + std::to_string(weights.size()) + " weights");
    return ImplicitFunction(kernel, UnitFrame{frame_center_mm, frame_scale_mm}, point_arrays(centers), weights,
                            {p[0], p[1], p[2], p[3]});
}

py::array_t<double> values_at(const ImplicitFunction& function, const ArrayOf<double>& points, int threads) {
    py::array_t<double> values(leading_shape(points));
    const std::span out(values.mutable_data(), static_cast<std::size_t>(values.size()));
    const ReleasedLock released;
    function.values(span_of(points), out, {.threads = threads});
    return values;
}

py::array_t<double> gradients_at(const ImplicitFunction& function, const ArrayOf<double>& points, int threads) {
    std::vector<py::ssize_t> shape = leading_shape(points);
    shape.push_back(3);
    py::array_t<double> gradients(shape);
    const std::span out(reinterpret_cast<Vec3*>(gradients.mutable_data()), static_cast<std::size_t>(gradients.size() / 3));
    const ReleasedLock released;
    function.gradients(span_of(points), out, {.threads = threads});
    return gradients;
}

}  // namespace

void bind_functions(py::module_& m, py::module_& stages) {
    py::class_<ImplicitFunction> function(m, "ImplicitFunction", R"(The fitted surface as a function f of space. Immutable.

f(x) = p0 + p . x + sum of w_j phi(|x - c_j|); f > 0 inside, in mm near the surface. Calling it gives its values.

Parameters
----------
kernel : {'screened', 'triharmonic', 'biharmonic'}
    phi(r) = 192 (1 + r / 4) exp(-r / 4), r^3 or r.
frame_center_mm : array_like, shape (3,)
frame_scale_mm : float
    Unit coordinates u = (x - frame_center_mm) / frame_scale_mm, on which the other parameters are.
centers : array_like, shape (n, 3)
weights : array_like, shape (n,)
polynomial : array_like, shape (4,)
    p0 and p. With the screened kernel p0 is the mean and p is 0; beyond a, the larger of 1.25 and the farthest centre's
    distance from 0, f is less by 16 frame_scale_mm (|u| - a)^3.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> result = kontur.segment(case.contours, case.grid)
>>> inside, outside = result.function(case.grid.bounds_mm.mean(0)), result.function([0, 0, 0])
>>> float(outside) < 0
True
)");
    constructor(function, &function_from, py::arg("kernel"), py::arg("frame_center_mm"), py::arg("frame_scale_mm"),
                py::arg("centers"), py::arg("weights"), py::arg("polynomial"));
    function.def_property_readonly("kernel", &ImplicitFunction::kernel, "{'screened', 'triharmonic', 'biharmonic'}");
    function.def_property_readonly(
        "frame_center_mm", [](const ImplicitFunction& f) { return f.frame().center; }, "ndarray, shape (3,), float64");
    function.def_property_readonly(
        "frame_scale_mm", [](const ImplicitFunction& f) { return f.frame().scale; }, "float");
    function.def_property_readonly("centers", &points_of_function, "ndarray, shape (n, 3), float64: on unit coordinates.");
    function.def_property_readonly(
        "weights",
        [](const ImplicitFunction& f) {
            return py::array_t<double>(static_cast<py::ssize_t>(f.weights().size()), f.weights().data());
        },
        "ndarray, shape (n,), float64: on unit coordinates.");
    function.def_property_readonly(
        "polynomial", [](const ImplicitFunction& f) { return py::array_t<double>(4, f.polynomial().data()); },
        "ndarray, shape (4,), float64: on unit coordinates; with the screened kernel the mean and 0.");
    method(function, "values", R"(Values of f at points.

Parameters
----------
points : array_like, shape (..., 3)
    mm (LPS); not copied when C-ordered float64.
threads : int
    0: the machine's. The values do not depend on it.

Returns
-------
ndarray, shape (...), float64
    About the distance to the surface in mm close to it, > 0 inside.
)",
           &values_at, py::arg("points"), kThreads);
    method(function, "__call__", "The same as `values`.", &values_at, py::arg("points"), kThreads);
    method(function, "gradients", R"(Gradients of f per mm at points; they point inward.

Parameters
----------
points : array_like, shape (..., 3)
    mm (LPS).
threads : int
    0: the machine's.

Returns
-------
ndarray, shape (..., 3), float64
)",
           &gradients_at, py::arg("points"), kThreads);
    function.def("__repr__", [](const ImplicitFunction& f) {
        return py::str("<ImplicitFunction, {}, {} centres>").format(py::cast(f.kernel()), f.centers().size());
    });
    function.def("__reduce__", [](const py::object& self) {
        py::list arguments;
        for (const char* name : {"kernel", "frame_center_mm", "frame_scale_mm", "centers", "weights", "polynomial"})
            arguments.append(self.attr(name));
        return py::make_tuple(py::type::of(self), py::tuple(arguments));
    });

    py::class_<Residual> residual_type(m, "Residual", "How far the fitted surface passes from the drawn points.");
    Fields(residual_type)
        .field("max_mm", &Residual::max_mm, "float")
        .field("rms_mm", &Residual::rms_mm, "float")
        .field("worst_contour", &Residual::worst_contour, "int: index of the contour with the largest one.")
        .picklable();
    residual_type.def("__repr__", [](const Residual& r) {
        return py::str("<Residual: max {:.3g} mm, rms {:.3g} mm>").format(r.max_mm, r.rms_mm);
    });
    define(
        stages, "residual", R"(First-order distance |f| / |grad f| of the surface from every drawn point of a border.

Parameters
----------
function : ImplicitFunction
contours : ContourSet
    Its holes are known; lines within the object do not count.
threads : int
    0: the machine's.

Returns
-------
Residual
)",
        [](const ImplicitFunction& f, const ContourSet& contours, int threads) {
            return unlocked([&] { return residual(f, contours, {.threads = threads}); });
        },
        py::arg("function"), py::arg("contours"), kThreads);
}

}  // namespace kontur::python
