// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "fields.h"
#include "kontur/shape/mesh.h"
#include "kontur/view/outline.h"

namespace kontur::python {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> triangles_from(const ArrayOf<std::int64_t>& indices, std::size_t point_count) {
    if (indices.size() == 0) return {};
    if (indices.ndim() != 2 || indices.shape(1) != 3)
        throw Error(ErrorKind::invalid_input,
                    "an array of triangles has the shape " + shape_text(indices) + "; (n, 3) is needed");
    std::vector<Triangle> triangles(static_cast<std::size_t>(indices.shape(0)));
    const std::int64_t* index = indices.data();
    for (Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) {
            if (*index < 0 || *index >= static_cast<std::int64_t>(point_count))
                throw Error(ErrorKind::invalid_input, "a triangle has the point " + std::to_string(*index) + "; there are " +
                                                          std::to_string(point_count));
            corner = static_cast<std::uint32_t>(*index++);
        }
    return triangles;
}

TriangleMesh mesh_from(std::vector<Vec3> points, const ArrayOf<std::int64_t>& triangles,
                       std::optional<std::vector<Vec3>> normals) {
    TriangleMesh mesh;
    mesh.triangles = triangles_from(triangles, points.size());
    mesh.points = std::move(points);
    mesh.normals = std::move(normals).value_or(std::vector<Vec3>{});
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.points.size())
        throw Error(ErrorKind::invalid_input, "a mesh of " + std::to_string(mesh.points.size()) + " points has " +
                                                  std::to_string(mesh.normals.size()) + " normals");
    return mesh;
}

template <class Value, class Element>
py::array rows(const std::vector<Element>& elements, const py::object& self) {
    return read_only(
        array_view(reinterpret_cast<const Value*>(elements.data()), {static_cast<py::ssize_t>(elements.size()), 3}, self));
}

}  // namespace

void bind_meshes(py::module_& m) {
    py::class_<TriangleMesh> mesh(m, "TriangleMesh", R"(An indexed triangle surface. Its arrays are read-only views.

Parameters
----------
points : array_like, shape (n, 3)
    mm (LPS).
triangles : array_like, shape (m, 3)
    Indices into `points`, counter-clockwise seen from outside.
normals : array_like, shape (n, 3), optional
    Unit, outward.

Examples
--------
>>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
>>> mesh = kontur.TriangleMesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
>>> round(kontur.signed_volume_mm3(mesh), 6), kontur.topology(mesh).closed
(0.166667, True)
)");
    constructor(mesh, &mesh_from, py::arg("points"), py::arg("triangles"), py::arg("normals") = py::none());
    mesh.def_property_readonly(
        "points", [](const py::object& self) { return rows<double>(self.cast<const TriangleMesh&>().points, self); },
        "ndarray, shape (n, 3), float64: mm (LPS).");
    mesh.def_property_readonly(
        "normals", [](const py::object& self) { return rows<double>(self.cast<const TriangleMesh&>().normals, self); },
        "ndarray, shape (n, 3), float64: unit, outward; shape (0, 3) when unknown.");
    mesh.def_property_readonly(
        "triangles",
        [](const py::object& self) { return rows<std::uint32_t>(self.cast<const TriangleMesh&>().triangles, self); },
        "ndarray, shape (m, 3), uint32: indices into points.");
    mesh.def("__repr__", [](const TriangleMesh& self) {
        return py::str("<TriangleMesh of {} points, {} triangles>").format(self.points.size(), self.triangles.size());
    });
    mesh.def("__reduce__", [](const py::object& self) {
        return py::make_tuple(py::type::of(self),
                              py::make_tuple(self.attr("points"), self.attr("triangles"), self.attr("normals")));
    });

    py::class_<MeshTopology> topology_type(m, "MeshTopology", "What makes a mesh a solid's surface.");
    Fields(topology_type)
        .field("closed", &MeshTopology::closed, "bool: every edge belongs to two triangles.")
        .field("oriented", &MeshTopology::oriented, "bool: which run through it in opposite directions.")
        .field("euler", &MeshTopology::euler, "int: points - edges + triangles.")
        .field("components", &MeshTopology::components, "int")
        .picklable();
    topology_type.def("__repr__", [](const MeshTopology& t) {
        return py::str("<MeshTopology: {}closed, {}oriented, Euler number {}, {} components>")
            .format(t.closed ? "" : "not ", t.oriented ? "" : "not ", t.euler, t.components);
    });

    define(m, "signed_volume_mm3", "Enclosed volume in mm^3; negative when the triangles are turned inward.",
           &signed_volume_mm3, py::arg("mesh"));
    define(
        m, "topology", "The MeshTopology of a mesh.",
        [](const TriangleMesh& self) { return unlocked([&] { return topology(self); }); }, py::arg("mesh"));
    define(
        m, "outline", R"(A mesh's surface cut by a plane.

Parameters
----------
mesh : TriangleMesh
plane : Plane

Returns
-------
list of (ndarray, bool)
    Points of a line, shape (n, 3), mm (LPS), and whether it is closed; a closed line does not repeat its first point.
)",
        [](const TriangleMesh& self, const Plane& plane) {
            py::list lines;
            for (Polyline& line : unlocked([&] { return outline(self, plane); }))
                lines.append(py::make_tuple(std::move(line.points), line.closed));
            return lines;
        },
        py::arg("mesh"), py::arg("plane"));
    define(m, "crossings", "Points in mm where a contour's line crosses the plane: ndarray, shape (n, 3).", &crossings,
           py::arg("contour"), py::arg("plane"));
}

}  // namespace kontur::python
