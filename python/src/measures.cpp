// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "fields.h"
#include "kontur/measure/compare.h"
#include "kontur/measure/differences.h"

namespace kontur::python {
namespace {

void bind_differences(py::module_& m) {
    py::class_<Difference> difference(m, "Difference", "Where one of two masks is, and the other is not.");
    Fields(difference)
        .field("at", &Difference::at, "ndarray, shape (3,): mm, the voxel that lies farthest from the other mask.")
        .field("distance_mm", &Difference::distance_mm, "float: of that voxel from the other mask's nearest one.")
        .field("volume_ml", &Difference::volume_ml, "float")
        .field("in_first", &Difference::in_first, "bool: it is the first mask that has it.")
        .picklable();
    difference.def("__repr__", [](const Difference& d) {
        return py::str("<Difference: {:.3g} mm, {:.3g} ml>").format(d.distance_mm, d.volume_ml);
    });
    define(
        m, "differences", R"(The places where two masks on one grid differ, the farthest first.

Together they are all voxels that one mask alone has. None where a mask is empty.

Parameters
----------
a, b : Mask
saddle : float
    Two bulges of one piece are two differences where the way between them comes nearer to the other mask than this share
    of the lower one's height. From above 0 to 1.
threads : int
    0: the machine's.
@progress

Returns
-------
list of Difference

Raises
------
InvalidInputError
    When the grids differ, saying how.

Examples
--------
>>> grid = kontur.Grid((8, 8, 8), np.eye(4), frame="LPS")
>>> a = kontur.Mask(np.pad(np.ones((4, 4, 4)), 2), grid)
>>> b = kontur.Mask(np.roll(a.values, 2, axis=2), grid)
>>> [(one.in_first, one.distance_mm) for one in kontur.differences(a, b)]
[(True, 2.0), (False, 2.0)]
)",
        [](const Mask& a, const Mask& b, double saddle, int threads, const py::object& progress, const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return differences(a, b, saddle, work); });
        },
        py::arg("a"), py::arg("b"), py::kw_only(), py::arg("saddle") = kSaddle, kThreads, kProgress, kStop);
}

}  // namespace

void bind_measures(py::module_& m) {
    py::class_<SurfaceDistance> distance(m, "SurfaceDistance", "Distances between the surfaces of two masks.");
    Fields(distance)
        .field("hausdorff_mm", &SurfaceDistance::hausdorff_mm, "float: the largest.")
        .field("hausdorff95_mm", &SurfaceDistance::hausdorff95_mm,
               "float: the 95th percentile of each direction, the larger one.")
        .field("mean_surface_distance_mm", &SurfaceDistance::mean_surface_distance_mm,
               "float: over both directions together.")
        .picklable();
    distance.def("__repr__", [](const SurfaceDistance& d) {
        return py::str("<SurfaceDistance: mean {:.3g} mm, Hausdorff {:.3g} mm>")
            .format(d.mean_surface_distance_mm, d.hausdorff_mm);
    });

    py::class_<Comparison> comparison(m, "Comparison", "How two masks of one grid agree.");
    Fields(comparison)
        .field("volume_a_ml", &Comparison::volume_a_ml, "float")
        .field("volume_b_ml", &Comparison::volume_b_ml, "float")
        .field("dice", &Comparison::dice, "float: 1 when both are empty.")
        .field("jaccard", &Comparison::jaccard, "float: 1 when both are empty.")
        .field("surface", &Comparison::surface, "SurfaceDistance, or None when a mask is empty.")
        .picklable();
    comparison.def("__repr__", [](const Comparison& c) { return py::str("<Comparison: Dice {:.4f}>").format(c.dice); });

    define(
        m, "compare", R"(Overlap and surface distances of two masks on one grid.

Parameters
----------
a, b : Mask
threads : int
    0: the machine's.
@progress

Returns
-------
Comparison

Raises
------
InvalidInputError
    When the grids differ, saying how.

Examples
--------
>>> grid = kontur.Grid((8, 8, 8), np.eye(4), frame="LPS")
>>> a = kontur.Mask(np.pad(np.ones((4, 4, 4)), 2), grid)
>>> b = kontur.Mask(np.roll(a.values, 1, axis=2), grid)
>>> agreement = kontur.compare(a, b)
>>> agreement.dice, agreement.surface.hausdorff_mm
(0.75, 1.0)
)",
        [](const Mask& a, const Mask& b, int threads, const py::object& progress, const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return compare(a, b, work); });
        },
        py::arg("a"), py::arg("b"), kThreads, py::kw_only(), kProgress, kStop);
    bind_differences(m);
}

}  // namespace kontur::python
