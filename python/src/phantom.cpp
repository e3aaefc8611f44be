// SPDX-License-Identifier: Apache-2.0
#include "kontur/phantom/phantom.h"
#include "bindings.h"
#include "kontur/base/counted.h"
#include "kontur/phantom/bodies.h"
#include "kontur/phantom/cases.h"
#include "kontur/phantom/dense_liver.h"
#include "kontur/phantom/volumes.h"

namespace kontur::python {
namespace {

void bind_body(py::module_& m) {
    py::class_<Body> body(m, "Body", "A smooth solid of the phantom, in mm (LPS).");
    body.def_property_readonly("name", &Body::name, "str");
    body.def_property_readonly("bounds", &Body::bounds, "ndarray, shape (2, 3): a box, a few mm too large, mm.");
    method(
        body, "values", "About the depth in mm below the surface at points, shape (n, 3): ndarray, shape (n,), > 0 inside.",
        [](const Body& self, const ArrayOf<double>& points) {
            std::vector<double> values;
            for (const Vec3& p : points_of(points)) values.push_back(self.value(p));
            const auto count = static_cast<py::ssize_t>(values.size());
            return owning_array(std::move(values), {count});
        },
        py::arg("points"));
    method(
        body, "outward_normals", "Unit outward normals at points, shape (n, 3): ndarray, shape (n, 3).",
        [](const Body& self, const ArrayOf<double>& points) {
            std::vector<Vec3> normals;
            for (const Vec3& p : points_of(points)) normals.push_back(self.outward_normal(p));
            return normals;
        },
        py::arg("points"));
    body.def("__repr__", [](const Body& self) { return py::str("<Body {!r}>").format(self.name()); });
}

}  // namespace

void bind_phantom(py::module_& m, py::module_& stages) {
    bind_body(m);
    py::class_<PhantomCase> phantom(m, "PhantomCase",
                                    "A contour set of the phantom with everything needed to judge a segmentation.");
    phantom.def_readonly("name", &PhantomCase::name, "str");
    phantom.def_readonly("note", &PhantomCase::note, "str: what it is and what it is for.");
    phantom.def_readonly("body", &PhantomCase::body, "Body: the truth; None for the self-intersecting curves.");
    phantom.def_readonly("contours", &PhantomCase::contours, "ContourSet");
    phantom.def_readonly("grid", &PhantomCase::grid, "Grid: to segment on.");
    phantom.def_readonly("normals", &PhantomCase::normals,
                         "list of ndarray, shape (n, 3): the body's at each contour's points.");
    phantom.def("__repr__", [](const PhantomCase& c) {
        return py::str("<PhantomCase {!r}: {}>").format(c.name, counted(c.contours.contours.size(), "contour"));
    });

    py::class_<PhantomVolume> volume(stages, "PhantomVolume", "A scan of the phantom.");
    volume.def_readonly("name", &PhantomVolume::name, "str");
    volume.def_readonly("note", &PhantomVolume::note, "str: what it shows.");
    volume.def_readonly("grid", &PhantomVolume::grid, "Grid");
    volume.def_readonly("bodies", &PhantomVolume::bodies, "list of Body: those that it shows whole.");
    volume.def("__repr__", [](const PhantomVolume& v) {
        return py::str("<PhantomVolume {!r} on {!r}>").format(v.name, py::cast(v.grid));
    });

    define(m, "phantom_bodies", "Liver, metastasis, kidney and vertebra of the phantom: list of Body.", &phantom_bodies);
    define(m, "phantom_case_names", "Names for `phantom_case`: list of str.", &phantom_case_names);
    define(
        m, "phantom_case", "The PhantomCase of that name, always the same.",
        [](const std::string& name) { return unlocked([&] { return phantom_case(name); }); }, py::arg("name"));
    const auto liver =
        Keywords<DenseLiver>()
            .field("points", &DenseLiver::points, "Of all contours together, at least 100.")
            .field("orthogonal", &DenseLiver::orthogonal, "In planes across all three axes, else in axial ones.")
            .field("by_hand", &DenseLiver::by_hand, "Drawn by an unsteady hand.");
    const std::string liver_doc = docstring(
        "dense_liver_case", "*", R"(The PhantomCase of a liver with many contours, to measure how time and memory grow.

Parameters
----------
@options
)",
        KeywordText(liver));
    stages.def(
        "dense_liver_case",
        [liver](const py::kwargs& given) {
            const DenseLiver options = liver.parse("dense_liver_case", given);
            return unlocked([&] { return dense_liver_case(options); });
        },
        liver_doc.c_str());
    define(stages, "phantom_volumes", "The scans that `kontur phantom` writes: list of PhantomVolume.", &phantom_volumes);

    const auto keywords = Keywords<PhantomOptions>()
                              .field("seed", &PhantomOptions::seed, "Of the noise.")
                              .field("noise_hu", &PhantomOptions::noise_hu, "Standard deviation, Hounsfield units.");
    define(
        m, "make_phantom_image", R"(A synthetic CT of the phantom's abdomen on any grid.

Parameters
----------
grid : Grid
@threads
@progress
@options

Returns
-------
Image
    int16, Hounsfield units.
)",
        [keywords](const Grid& grid, int threads, const py::object& progress, const py::object& stop,
                   const py::kwargs& given) {
            const PhantomOptions options = keywords.parse("make_phantom_image", given);
            return run({progress, stop, threads}, [&](const Work& work) { return make_phantom_image(grid, options, work); });
        },
        py::arg("grid"), py::kw_only(), kThreads, kProgress, kStop, KeywordText(keywords));
    define(
        m, "make_truth_mask", "The Mask of the voxels whose centres lie inside a body.",
        [](const Body& body, const Grid& grid, int threads) {
            return unlocked([&] { return make_truth_mask(body, grid, {.threads = threads}); });
        },
        py::arg("body"), py::arg("grid"), kThreads);
}

}  // namespace kontur::python
