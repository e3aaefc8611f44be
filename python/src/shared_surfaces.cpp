// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <limits>

#include "bindings.h"
#include "fields.h"
#include "kontur/io/meshes/region_mesh.h"
#include "kontur/segment_together.h"
#include "provenance.h"

namespace kontur::python {
namespace {

namespace fs = std::filesystem;

using Sides = std::array<std::uint32_t, 2>;

py::array sides_of(const py::object& self) {
    const std::vector<Sides>& sides = self.cast<const SharedSurface&>().sides;
    return read_only(
        array_view(reinterpret_cast<const std::uint32_t*>(sides.data()), {static_cast<py::ssize_t>(sides.size()), 2}, self));
}

std::vector<Sides> sides_from(const ArrayOf<std::int64_t>& given) {
    if (given.ndim() != 2 || given.shape(1) != 2)
        throw Error(ErrorKind::invalid_input,
                    "an array of the triangles' sides has the shape " + shape_text(given) + "; (m, 2) is needed");
    std::vector<Sides> sides(static_cast<std::size_t>(given.shape(0)));
    const std::int64_t* region = given.data();
    for (Sides& both : sides)
        for (std::uint32_t& side : both) {
            if (*region < 0 || *region > std::numeric_limits<std::uint32_t>::max())
                throw Error(ErrorKind::invalid_input, "a side of a triangle is the region " + std::to_string(*region));
            side = static_cast<std::uint32_t>(*region++);
        }
    return sides;
}

void bind_type(py::module_& m) {
    py::class_<SharedSurface> type(
        m, "SharedSurface",
        "The surfaces of several objects as one mesh: where two touch they have points and triangles in common.");
    Fields(type)
        .field("mesh", &SharedSurface::mesh, "TriangleMesh: without normals.")
        .field("regions", &SharedSurface::regions,
               "list of list of int: the positions of the objects that each region belongs to; region 0 belongs to none.")
        .stored("sides", &SharedSurface::sides)
        .picklable();
    type.def_property_readonly(
        "sides", &sides_of,
        "ndarray, shape (m, 2), uint32: for each triangle the regions behind it and in front of it, where "
        "its corners run counter-clockwise.");
    type.def("__repr__", [](const SharedSurface& self) {
        return py::str("<SharedSurface of {} points, {} triangles, {} regions>")
            .format(self.mesh.points.size(), self.mesh.triangles.size(), self.regions.size());
    });
}

}  // namespace

void bind_shared_surfaces(py::module_& m) {
    bind_type(m);
    define(
        m, "shared_surface", R"(The surfaces of structures that were segmented together, as one mesh.

Where two of them touch, they have their points and triangles in common. The surface closes half a voxel beyond the grid.

Parameters
----------
together : Together
@threads
@progress

Returns
-------
SharedSurface

Examples
--------
>>> liver = kontur.phantom_case("liver_oblique10")
>>> metastasis = kontur.phantom_case("metastasis_parallel7")
>>> both = kontur.segment_together([liver.contours, metastasis.contours], liver.grid)
>>> surface = kontur.shared_surface(both)
>>> surface.regions
[[], [0], [0, 1]]
>>> kontur.topology(kontur.surface_of(surface, 1)).closed
True
)",
        [](const Together& together, int threads, const py::object& progress, const py::object& stop) {
            return run({progress, stop, threads}, [&](const Work& work) { return shared_surface(together, work); });
        },
        py::arg("together"), kThreads, py::kw_only(), kProgress, kStop);
    define(
        m, "surface_of",
        "One object's surface, turned outward: the TriangleMesh of the points that it uses, empty without voxels.",
        [](const SharedSurface& surface, std::size_t object) {
            return unlocked([&] { return surface_of(surface, object); });
        },
        py::arg("surface"), py::arg("object"));
    define(
        m, "write_region_mesh",
        R"(Writes a .ply whose faces tell the regions on either side, in mm and LPS, whole or not at all.

Parameters
----------
path : path
mesh : TriangleMesh
names : sequence of str
    One for each region; the first one is outside of everything.
sides : array_like, shape (m, 2)
    For each triangle the regions behind it and in front of it: the faces' properties `behind` and `front`.
@provenance

Raises
------
InvalidInputError
    For other than one pair for each triangle, and for regions without a name.
UnsupportedError
    For another extension.
)",
        [](const fs::path& path, const TriangleMesh& mesh, std::vector<std::string> names,
           const ArrayOf<std::int64_t>& sides, const py::object& provenance) {
            const MeshRegions regions{std::move(names), sides_from(sides)};
            const Provenance entries = provenance_from(provenance);
            const ReleasedLock released;
            write_region_mesh(path, mesh, regions, entries);
        },
        py::arg("path"), py::arg("mesh"), py::arg("names"), py::arg("sides"), py::arg("provenance") = py::none());
}

}  // namespace kontur::python
