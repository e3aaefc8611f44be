// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/extract/adaptive.h"
#include "kontur/extract/polygonize.h"
#include "kontur/extract/preview.h"
#include "kontur/extract/rasterize.h"
#include "kontur/extract/slice_contours.h"
#include "kontur/extract/trace.h"
#include "kontur/extract/track.h"
#include "kontur/extract/voxelize.h"

namespace kontur::python {
namespace {

Keywords<TraceOptions> trace_keywords() {
    return Keywords<TraceOptions>()
        .field("step_mm", &TraceOptions::step_mm, "Sampling distance on a plane; 0: half the mask's smallest spacing.")
        .field("tolerance_mm", &TraceOptions::tolerance_mm, "How far dropped points may lie off the contour.")
        .field("min_area_mm2", &TraceOptions::min_area_mm2, "Smaller contours are dropped.");
}

void bind_lattice(py::module_& stages) {
    py::class_<SurfaceLattice> lattice(stages, "SurfaceLattice",
                                       "Where the surface passes through a grid, and the values found there.");
    lattice.def_property_readonly(
        "grid", [](const SurfaceLattice& s) { return s.lattice.grid(); }, "Grid");
    lattice.def_property_readonly(
        "cells",
        [](const SurfaceLattice& s) {
            static_assert(sizeof(Index3) == 3 * sizeof(std::int64_t));
            return owning_array<Index3, std::int64_t>(std::vector(s.cells), {static_cast<py::ssize_t>(s.cells.size()), 3});
        },
        "ndarray, shape (n, 3), int64: cells with corners inside and outside; the index (i, j, k) of the lowest corner.");
    lattice.def_readonly("evaluations", &SurfaceLattice::evaluations, "int: function values computed.");
}

/// One of the two ways to follow the surface; `summary` begins the docstring.
void bind_tracking(py::module_& stages, const char* name, const std::string& summary,
                   SurfaceLattice (*track)(const ImplicitFunction&, const Grid&, std::span<const Vec3>, const Work&)) {
    const std::string doc = summary + R"(

Parameters
----------
function : ImplicitFunction
grid : Grid
starts : array_like, shape (n, 3)
    mm (LPS); those outside of the grid are ignored.
threads : int
    0: the machine's.
@progress

Returns
-------
SurfaceLattice
    For `fill` and `polygonize`.
)";
    define(
        stages, name, doc.c_str(),
        [track](const ImplicitFunction& function, const Grid& grid, const std::vector<Vec3>& starts, int threads,
                const py::object& progress, const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return track(function, grid, starts, work); });
        },
        py::arg("function"), py::arg("grid"), py::arg("starts"), kThreads, py::kw_only(), kProgress, kStop);
}

}  // namespace

void bind_extraction(py::module_& m, py::module_& stages) {
    bind_lattice(stages);
    bind_tracking(stages, "track_surface", "Follows the surface from points on it.", &track_surface);
    bind_tracking(stages, "track_surface_adaptively",
                  R"(Follows the surface as `track_surface` does, from a fraction of the function values.

A coarse lattice first, then interpolation; values where that leaves the sign in doubt. Masks differ from those of
`track_surface` in a few voxels of a million. What `segment` does.)",
                  &track_surface_adaptively);
    define(
        stages, "preview_surface",
        R"(The surface through the starts on a lattice of its own, whatever grid a mask would have.

Parameters
----------
function : ImplicitFunction
starts : array_like, shape (n, 3)
    mm (LPS): points on contours.
spacing_mm : float
    Of the lattice; details thinner than it may be missing.
threads : int
    0: the machine's.
anchor_mm : array_like, shape (3,)
    Where one of the lattice's points lies, mm (LPS).
@progress

Returns
-------
TriangleMesh
    Closed, with outward normals; cut off where it runs farther from the starts' box than half of its diagonal.
)",
        [](const ImplicitFunction& function, const std::vector<Vec3>& starts, double spacing_mm, int threads,
           const Vec3& anchor_mm, const py::object& progress, const py::object& stop) {
            const PreviewOptions options{.spacing_mm = spacing_mm, .anchor_mm = anchor_mm};
            return run({progress, stop, threads},
                       [&](const Work& work) { return preview_surface(function, starts, options, work); });
        },
        py::arg("function"), py::arg("starts"), py::arg("spacing_mm") = PreviewOptions{}.spacing_mm, kThreads,
        py::arg("anchor_mm") = py::make_tuple(0.0, 0.0, 0.0), py::kw_only(), kProgress, kStop);
    define(
        stages, "slice_contours", R"(The surface where it passes through the slices (constant k) of its mask's grid.

Parameters
----------
mask : Mask
function : ImplicitFunction
    The mask's, as `segment` gives both.
threads : int
    0: the machine's.
@progress

Returns
-------
ContourSet
    They enclose exactly the mask's voxel centres; holes are marked.
)",
        [](const Mask& mask, const ImplicitFunction& function, int threads, const py::object& progress,
           const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return slice_contours(mask, function, work); });
        },
        py::arg("mask"), py::arg("function"), kThreads, py::kw_only(), kProgress, kStop);
    define(
        stages, "sample_everywhere", R"(Evaluates every voxel centre: slow, and finds what no start leads to.

Parameters
----------
function : ImplicitFunction
grid : Grid
threads : int
    0: the machine's.
@progress

Returns
-------
SurfaceLattice
)",
        [](const ImplicitFunction& function, const Grid& grid, int threads, const py::object& progress,
           const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return sample_everywhere(function, grid, work); });
        },
        py::arg("function"), py::arg("grid"), kThreads, py::kw_only(), kProgress, kStop);
    define(
        stages, "fill", "The Mask of the voxels inside of the surface found.",
        [](const SurfaceLattice& surface, int threads) {
            return unlocked([&] { return fill(surface, {.threads = threads}); });
        },
        py::arg("surface"), kThreads);
    define(
        stages, "polygonize", R"(The surface as a closed TriangleMesh with normals.

Parameters
----------
surface : SurfaceLattice
function : ImplicitFunction
    The one that the surface was found with.
threads : int
    0: the machine's.
@progress

Returns
-------
TriangleMesh
)",
        [](const SurfaceLattice& surface, const ImplicitFunction& function, int threads, const py::object& progress,
           const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return polygonize(surface, function, work); });
        },
        py::arg("surface"), py::arg("function"), kThreads, py::kw_only(), kProgress, kStop);
    define(
        stages, "rasterize", R"(The voxels that contours drawn on the grid's slices (constant k) enclose, even-odd.

Parameters
----------
contours : ContourSet
grid : Grid

Returns
-------
Mask
)",
        [](const ContourSet& contours, const Grid& grid) { return unlocked([&] { return rasterize(contours, grid); }); },
        py::arg("contours"), py::arg("grid"));

    const auto tracing = trace_keywords();
    define(
        m, "trace", R"(Cuts a mask by planes of any orientation into closed contours.

Parameters
----------
mask : Mask
planes : sequence of Plane
@threads
@progress
@options

Returns
-------
ContourSet
    Plane by plane; holes are marked.

Examples
--------
>>> grid = kontur.Grid((8, 8, 8), np.eye(4), frame="LPS")
>>> cube = kontur.Mask(np.pad(np.ones((4, 4, 4)), 2), grid)
>>> contours = kontur.trace(cube, [kontur.Plane([0, 0, 3.5], [0, 0, 1])])
>>> contours.bounding_box.round(6).tolist()
[[1.5, 1.5, 3.5], [5.5, 5.5, 3.5]]
)",
        [tracing](const Mask& mask, const std::vector<Plane>& planes, int threads, const py::object& progress,
                  const py::object& stop, const py::kwargs& given) {
            const TraceOptions options = tracing.parse("trace", given);
            return run({progress, stop, threads}, [&](const Work& work) { return trace(mask, planes, options, work); });
        },
        py::arg("mask"), py::arg("planes"), py::kw_only(), kThreads, kProgress, kStop, KeywordText(tracing));
}

}  // namespace kontur::python
