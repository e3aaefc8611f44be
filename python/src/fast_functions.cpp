// SPDX-License-Identifier: Apache-2.0
#include <mutex>

#include "bindings.h"
#include "kontur/function/fast_function.h"
#include "points.h"

namespace kontur::python {
namespace {

/// FastFunction is for one thread at a time and ends with a call that was stopped; Python's threads come as they like, and
/// Ctrl-C stops a call but not a session.
class SharedFastFunction {
public:
    SharedFastFunction(const ImplicitFunction& function, const FastOptions& options) : options_(options) {
        fast_.emplace(function, options);
    }

    template <class Call>
    auto with(const Call& call) {
        const std::scoped_lock lock(mutex_);
        try {
            return call(*fast_);
        } catch (...) {
            const ImplicitFunction function = fast_->exact();
            fast_.emplace(function, options_);
            throw;
        }
    }

private:
    std::mutex mutex_;
    FastOptions options_;
    std::optional<FastFunction> fast_;
};

py::array_t<double> values_at(SharedFastFunction& self, const ArrayOf<double>& points, int threads,
                              const py::object& progress, const py::object& stop) {
    py::array_t<double> values(leading_shape(points));
    const std::span out(values.mutable_data(), static_cast<std::size_t>(values.size()));
    run_work({progress, stop, threads}, [&, all = span_of(points)](const Work& work) {
        self.with([&](FastFunction& fast) { fast.values(all, out, work); });
    });
    return values;
}

py::array_t<double> gradients_at(SharedFastFunction& self, const ArrayOf<double>& points, int threads,
                                 const py::object& progress, const py::object& stop) {
    std::vector<py::ssize_t> shape = leading_shape(points);
    shape.push_back(3);
    py::array_t<double> gradients(shape);
    const std::span out(reinterpret_cast<Vec3*>(gradients.mutable_data()), static_cast<std::size_t>(gradients.size() / 3));
    run_work({progress, stop, threads}, [&, all = span_of(points)](const Work& work) {
        self.with([&](FastFunction& fast) { fast.gradients(all, out, work); });
    });
    return gradients;
}

/// A property that is not asked for while another thread computes.
template <class Value>
auto observed(Value (FastFunction::*observer)() const) {
    return [observer](SharedFastFunction& self) {
        return unlocked([&] { return self.with([&](FastFunction& fast) { return (fast.*observer)(); }); });
    };
}

}  // namespace

void bind_fast_functions(py::module_& m) {
    const auto keywords =
        Keywords<FastOptions>()
            .field("tolerance_mm", &FastOptions::tolerance_mm, "Largest error of a value accepted where it is checked.")
            .field("gradient_tolerance", &FastOptions::gradient_tolerance,
                   "Largest error of a gradient (mm per mm) accepted there.")
            .field("expected_points", &FastOptions::expected_points,
                   "How many will be evaluated; decides what preparation pays.");
    const std::string help = filled_in(R"(Values and gradients of an ImplicitFunction at many points, faster.

Near centres are summed directly, the smooth rest is interpolated. Each call compares some of its values with direct sums; if
one misses the tolerance, that call and all later ones are direct sums. Keeps what it computed for later calls.

Parameters
----------
function : ImplicitFunction
@options

Examples
--------
>>> case = kontur.phantom_case("liver_orthogonal14")
>>> function = kontur.segment(case.contours, kontur.grid_around(case.contours.bounding_box, [8, 8, 8], 10)).function
>>> box = case.contours.bounding_box
>>> points = np.random.default_rng(1).uniform(*box, (100_000, 3))
>>> fast = kontur.stages.FastFunction(function, expected_points=len(points))
>>> bool(abs(fast.values(points[:1000]) - function(points[:1000])).max() < 0.01)
True
)",
                                       keywords.documentation());
    py::class_<SharedFastFunction> fast(m, "FastFunction", help.c_str());
    const std::string init_doc = docstring("__init__", "self, function, *", "", KeywordText(keywords));
    fast.def(py::init([keywords](const ImplicitFunction& function, const py::kwargs& given) {
                 const FastOptions options = keywords.parse("FastFunction", given);
                 return std::make_unique<SharedFastFunction>(function, options);
             }),
             py::arg("function"), init_doc.c_str());
    method(fast, "values", R"(f at points, in mm close to the surface, > 0 inside.

Parameters
----------
points : array_like, shape (..., 3)
    mm (LPS).
@threads
@progress

Returns
-------
ndarray, shape (...), float64
)",
           &values_at, py::arg("points"), py::kw_only(), kThreads, kProgress, kStop);
    method(fast, "gradients", R"(Gradients of f per mm at points; they point inward.

Parameters
----------
points : array_like, shape (..., 3)
    mm (LPS).
@threads
@progress

Returns
-------
ndarray, shape (..., 3), float64
)",
           &gradients_at, py::arg("points"), py::kw_only(), kThreads, kProgress, kStop);
    fast.def_property_readonly(
        "exact",
        [](SharedFastFunction& self) { return self.with([](FastFunction& f) { return ImplicitFunction(f.exact()); }); },
        "ImplicitFunction: what it computes.");
    fast.def_property_readonly("error_mm", observed(&FastFunction::error_mm),
                               "float: the largest error of a value found so far; 0 while all are direct sums.");
    fast.def_property_readonly("is_direct", observed(&FastFunction::is_direct), "bool: values are direct sums now.");
    fast.def_property_readonly("kernel_values", observed(&FastFunction::kernel_values),
                               "int: kernel values computed so far.");
}

}  // namespace kontur::python
