// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/contours.h"
#include "kontur/io/contours/contour_json.h"
#include "kontur/io/meshes/mesh.h"
#include "kontur/io/read_provenance.h"
#include "notes.h"
#include "provenance.h"
#include "roi_name.h"

namespace kontur::python {

template <>
struct Words<Curves> {
    static constexpr std::array values{Curves::spline, Curves::polygon};
};

namespace {

namespace fs = std::filesystem;

/// A writer of contours that runs without the interpreter's lock.
auto writer(void (*write)(const fs::path&, const ContourSet&, const Provenance&)) {
    return [write](const fs::path& path, const ContourSet& contours, const py::object& items) {
        const Provenance provenance = provenance_from(items);
        const ReleasedLock released;
        write(path, contours, provenance);
    };
}

}  // namespace

void bind_files(py::module_& m) {
    const double tolerance = ReadContoursOptions{}.plane_tolerance_mm;
    const py::arg_v made = py::arg("provenance") = py::none();  // a dict of how they were made, for the file's text
    define(
        m, "read_contours", R"(Contours of one object from kontur's JSON, 3D Slicer's markups or an RT structure set.

Parameters
----------
path : path or sequence of paths
    The files' content decides on the format; several files become one object.
roi : str or int, optional
    RT structure sets: the ROI's name or number; needed when several have contours.
plane_tolerance_mm : float
    For curves whose plane must be fitted.
curves : {'spline', 'polygon'}, optional
    The line between the points of 3D Slicer's curves: as it draws them, or straight; None: splines.
@on_note

Returns
-------
ContourSet
)",
        [](const std::variant<ExistingPath, std::vector<ExistingPath>>& given, const std::optional<RoiName>& roi,
           double plane_tolerance_mm, const std::optional<Curves>& curves, const py::object& on_note) {
            const ReadContoursOptions options{roi_name(roi), plane_tolerance_mm, curves};
            ReadContours read = unlocked([&] {
                if (const auto* path = std::get_if<ExistingPath>(&given)) return read_contours(*path, options);
                const auto& paths = std::get<std::vector<ExistingPath>>(given);
                return read_contours(std::vector<fs::path>(paths.begin(), paths.end()), options);
            });
            give_notes(read.notes, on_note);
            return std::move(read.contours);
        },
        py::arg("path"), py::kw_only(), py::arg("roi") = py::none(), py::arg("plane_tolerance_mm") = tolerance,
        py::arg("curves") = py::none(), kOnNote);
    define(m, "write_contours",
           "Writes 3D Slicer's markups to a name ending in .mrk.json, kontur's JSON to any other .json.",
           writer(&write_contours), py::arg("path"), py::arg("contours"), made);
    define(
        m, "read_contour_json", R"(What kontur's own contour file holds.

Parameters
----------
path : path

Returns
-------
ContourSet
)",
        [](const ExistingPath& path) { return read_contour_json(path); }, py::arg("path"));
    define(
        m, "read_planes_json", R"(The planes of kontur's contour file, with or without contours.

Parameters
----------
path : path

Returns
-------
list of Plane
)",
        [](const ExistingPath& path) { return read_planes_json(path); }, py::arg("path"));
    define(m, "write_contour_json", "Writes kontur's contour file; reading it gives the same numbers.",
           writer(&write_contour_json), py::arg("path"), py::arg("contours"), made);
    define(
        m, "read_mesh", "The TriangleMesh of an STL, PLY or OBJ file, turned to LPS where it declares RAS.",
        [](const ExistingPath& path) { return unlocked([&] { return read_mesh(path); }); }, py::arg("path"));
    define(
        m, "write_mesh", R"(Writes a mesh as .stl, .ply or .obj, in mm and LPS, whole or not at all.

Parameters
----------
path : path
mesh : TriangleMesh
@provenance
)",
        [](const fs::path& path, const TriangleMesh& mesh, const py::object& provenance) {
            const Provenance entries = provenance_from(provenance);
            const ReleasedLock released;
            write_mesh(path, mesh, entries);
        },
        py::arg("path"), py::arg("mesh"), py::arg("provenance") = py::none());
    define(
        m, "read_provenance", R"(What kontur wrote into a file about how it was made; empty where the file says nothing.

MetaImage and STL hold it shortened, as the one entry 'shortened'.

Parameters
----------
path : path
    A mask, image, contour file or mesh, written by kontur or by any other program.

Returns
-------
dict of str to str
)",
        [](const ExistingPath& path) {
            py::dict items;
            for (const auto& [name, value] : unlocked([&] { return read_provenance(path); })) items[py::str(name)] = value;
            return items;
        },
        py::arg("path"));
}

}  // namespace kontur::python
