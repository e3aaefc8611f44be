// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/geometry/affine_frame.h"

namespace kontur::python {
namespace {

bool is_ras(const std::string& frame) {
    if (frame != "LPS" && frame != "RAS")
        throw Error(ErrorKind::invalid_input, "frame: 'LPS' or 'RAS' is needed, not '" + frame + "'");
    return frame == "RAS";
}

Affine3 affine_from(const ArrayOf<double>& matrix) {
    if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
        throw Error(ErrorKind::invalid_input, "an affine has the shape " + shape_text(matrix) + "; (4, 4) is needed");
    const auto m = matrix.unchecked<2>();
    if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1)
        throw Error(ErrorKind::invalid_input, "the last row of an affine is not 0 0 0 1");
    Affine3 affine;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) affine.linear[row][column] = m(row, column);
        affine.translation[row] = m(row, 3);
    }
    return affine;
}

py::array_t<double> matrix_of(const Affine3& affine) {
    py::array_t<double> matrix({4, 4});
    auto m = matrix.mutable_unchecked<2>();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) m(row, column) = affine.linear[row][column];
        m(row, 3) = affine.translation[row];
        m(3, row) = 0;
    }
    m(3, 3) = 1;
    return matrix;
}

Grid checked(const Grid& grid) {
    check_grid(grid);
    return grid;
}

/// Told nothing: a mirrored patient looks like a patient.
Grid refuse_unknown_frame(const py::object&, const py::object&) {
    throw py::type_error("a grid's affine needs its frame: 'LPS' (DICOM, ITK, kontur) or 'RAS' (NIfTI, nibabel)");
}

Grid grid_from(const Index3& size, const ArrayOf<double>& index_to_mm, const std::string& frame) {
    const Affine3 affine = affine_from(index_to_mm);
    return checked({size, is_ras(frame) ? ras_to_lps(affine) : affine});
}

/// Of Python's numbers, among which 0.0 and -0.0 are one, as they are for ==.
py::ssize_t hash_of(const Grid& grid) {
    py::list numbers(matrix_of(grid.index_to_mm).attr("ravel")().attr("tolist")());
    numbers.append(py::cast(grid.size));
    return py::hash(py::tuple(numbers));
}

/// ITK's way to say the same; the columns of `direction` are the axes.
Grid grid_from_spacing(const Index3& size, const Vec3& spacing_mm, const Vec3& origin_mm,
                       const std::optional<std::array<std::array<double, 3>, 3>>& direction) {
    Grid grid{size, {}};
    if (direction) grid.index_to_mm.linear = *direction;
    for (int axis = 0; axis < 3; ++axis) grid.index_to_mm.set_column(axis, spacing_mm[axis] * grid.index_to_mm.column(axis));
    grid.index_to_mm.translation = origin_mm;
    return checked(grid);
}

}  // namespace

void bind_grids(py::module_& m) {
    py::class_<Grid> grid(m, "Grid", R"(A regular lattice of voxel centres. Immutable.

Parameters
----------
size : (int, int, int)
    Voxels along i, j, k; arrays over the grid have the shape (k, j, i).
index_to_mm : array_like, shape (4, 4)
    Affine from voxel indices (0-based, voxel centres) to mm. Oblique, sheared and left-handed axes are all valid.
frame : {'LPS', 'RAS'}
    The frame that `index_to_mm` leads to: kontur, DICOM and ITK use LPS, NIfTI and nibabel RAS. It is always told.

Examples
--------
>>> grid = kontur.Grid((4, 3, 2), np.diag([1, 1, 2.5, 1]), frame="LPS")
>>> grid.shape, grid.spacing_mm.tolist(), grid.voxel_count
((2, 3, 4), [1.0, 1.0, 2.5], 24)
>>> grid.affine("RAS").diagonal().tolist()
[-1.0, -1.0, 2.5, 1.0]
)");
    constructor(grid, &grid_from, py::arg("size"), py::arg("index_to_mm"), py::arg("frame"));
    grid.def(py::init(&refuse_unknown_frame), py::arg("size"), py::arg("index_to_mm"));
    grid.def_static("from_spacing", &grid_from_spacing, py::arg("size"), py::arg("spacing_mm"),
                    py::arg("origin_mm") = Vec3{}, py::arg("direction") = py::none(),
                    R"(from_spacing(size, spacing_mm, origin_mm=(0.0, 0.0, 0.0), direction=None)
--

The grid as ITK describes it, in LPS.

Parameters
----------
size : (int, int, int)
    Voxels along i, j, k.
spacing_mm, origin_mm : array_like, shape (3,)
direction : array_like, shape (3, 3), optional
    Its columns are the unit axes; the identity when left out.

Returns
-------
Grid
)");
    grid.def_readonly("size", &Grid::size, "(int, int, int): voxels along i, j, k.");
    grid.def_property_readonly(
        "shape", [](const Grid& g) { return py::make_tuple(g.size.k, g.size.j, g.size.i); },
        "(int, int, int): of an array over the grid, (z, y, x).");
    grid.def_property_readonly(
        "index_to_mm", [](const Grid& g) { return matrix_of(g.index_to_mm); },
        "ndarray, shape (4, 4), float64: voxel indices (i, j, k) to mm, LPS.");
    method(
        grid, "affine", "The affine from voxel indices (i, j, k) to mm in the frame 'LPS' or 'RAS': ndarray, shape (4, 4).",
        [](const Grid& g, const std::string& frame) {
            return matrix_of(is_ras(frame) ? lps_to_ras(g.index_to_mm) : g.index_to_mm);
        },
        py::arg("frame"));
    grid.def_property_readonly("spacing_mm", &Grid::spacing_mm, "ndarray, shape (3,): step along i, j, k.");
    grid.def_property_readonly("voxel_count", &Grid::voxel_count, "int");
    grid.def_property_readonly("voxel_volume_mm3", &Grid::voxel_volume_mm3, "float");
    grid.def_property_readonly("bounds_mm", &Grid::bounds_mm,
                               "ndarray, shape (2, 3): box of the outer faces of all voxels, LPS.");
    grid.def(
        "__eq__", [](const Grid& a, const Grid& b) { return a == b; }, py::is_operator());
    grid.def("__hash__", &hash_of);
    grid.def("__repr__", [](const Grid& g) {
        return py::str("<Grid {} x {} x {}, {:g} x {:g} x {:g} mm>")
            .format(g.size.i, g.size.j, g.size.k, g.spacing_mm().x, g.spacing_mm().y, g.spacing_mm().z);
    });
    picklable(grid, [](const Grid& g) { return py::make_tuple(g.size, matrix_of(g.index_to_mm), "LPS"); });

    define(m, "grid_around", R"(An axis-aligned LPS grid whose voxels cover a box with a margin.

Parameters
----------
box : array_like, shape (2, 3)
    Lowest and highest coordinates, mm; such as `ContourSet.bounding_box`.
spacing_mm : array_like, shape (3,)
margin_mm : float

Returns
-------
Grid
)",
           &grid_around, py::arg("box"), py::arg("spacing_mm"), py::arg("margin_mm"));
    define(m, "corner_distance_mm", "Largest distance in mm between two grids' corner voxels; inf if their sizes differ.",
           &corner_distance_mm, py::arg("a"), py::arg("b"));
}

}  // namespace kontur::python
