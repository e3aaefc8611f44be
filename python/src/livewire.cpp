// SPDX-License-Identifier: Apache-2.0
#include "kontur/view/livewire.h"

#include "bindings.h"

namespace kontur::python {
namespace {

using Position = std::array<int, 2>;  ///< column, row

EdgeMap edges_of(const ArrayOf<float>& values) {
    if (values.ndim() != 2)
        throw Error(ErrorKind::invalid_input, "a slice has the shape " + shape_text(values) + "; (rows, columns) is needed");
    return unlocked([&] {
        return EdgeMap({values.data(), static_cast<std::size_t>(values.size())}, static_cast<int>(values.shape(1)),
                       static_cast<int>(values.shape(0)));
    });
}

Pixel pixel_of(const EdgeMap& edges, const Position& position) {
    const Pixel pixel{position[0], position[1]};
    if (!edges.contains(pixel))
        throw Error(ErrorKind::invalid_input, "the pixel (" + std::to_string(pixel.column) + ", " +
                                                  std::to_string(pixel.row) + ") lies outside of the slice of " +
                                                  std::to_string(edges.width()) + " x " + std::to_string(edges.height()));
    return pixel;
}

py::array_t<double> strengths(const EdgeMap& edges) {
    py::array_t<double> all({edges.height(), edges.width()});
    double* out = all.mutable_data();
    for (int row = 0; row < edges.height(); ++row)
        for (int column = 0; column < edges.width(); ++column) *out++ = edges.strength({column, row});
    return all;
}

py::array_t<int> path_array(const std::vector<Pixel>& path) {
    static_assert(sizeof(Pixel) == 2 * sizeof(int));
    const auto count = static_cast<py::ssize_t>(path.size());
    return owning_array<Pixel, int>(std::vector(path), {count, 2});
}

std::vector<Pixel> path_from(const EdgeMap& edges, const ArrayOf<int>& path) {
    if (path.ndim() != 2 || path.shape(1) != 2)
        throw Error(ErrorKind::invalid_input, "a path has the shape " + shape_text(path) + "; (n, 2) is needed");
    std::vector<Pixel> pixels;
    for (py::ssize_t n = 0; n < path.shape(0); ++n) pixels.push_back(pixel_of(edges, {path.at(n, 0), path.at(n, 1)}));
    return pixels;
}

}  // namespace

void bind_livewire(py::module_& m) {
    py::class_<EdgeMap> edges(m, "EdgeMap", R"(How well each pixel of a slice lies on an edge, and which way the edge runs.

Parameters
----------
values : array_like, shape (rows, columns)
    Intensities, such as `reslice` gives; at least 3 x 3.

Examples
--------
>>> rows, columns = np.mgrid[:64, :64]
>>> disc = np.hypot(rows - 32, columns - 32) < 20
>>> edges = kontur.stages.EdgeMap(100 * disc)
>>> start = edges.snap((51, 31), radius=3)
>>> path = kontur.stages.LiveWire(edges, start).path_to(edges.snap((32, 12), radius=3))
>>> line = kontur.stages.smooth_path(edges, path)
>>> bool(abs(np.hypot(*(line - [32, 32]).T) - 20).max() < 1)
True
)");
    constructor(edges, &edges_of, py::arg("values"));
    edges.def_property_readonly("width", &EdgeMap::width, "int: columns.");
    edges.def_property_readonly("height", &EdgeMap::height, "int: rows.");
    edges.def_property_readonly("strengths", &strengths,
                                "ndarray, shape (rows, columns), float64: 0 (no edge) to 1 (clear edge).");
    method(
        edges, "snap", R"(The strongest edge pixel close by, nearer ones preferred; the pixel itself where there is no edge.

Parameters
----------
pixel : (int, int)
    Column, row.
radius : int
    Pixels.

Returns
-------
(int, int)
)",
        [](const EdgeMap& self, const Position& pixel, int radius) {
            const Pixel found = self.snap(pixel_of(self, pixel), radius);
            return py::make_tuple(found.column, found.row);
        },
        py::arg("pixel"), py::arg("radius"));
    method(
        edges, "subpixel_position",
        "The edge's position to a fraction of a pixel: (column, row) as floats; the pixel's centre elsewhere.",
        [](const EdgeMap& self, const Position& pixel) {
            const PixelPosition found = self.subpixel_position(pixel_of(self, pixel));
            return py::make_tuple(found[0], found[1]);
        },
        py::arg("pixel"));

    py::class_<LiveWire> wire(m, "LiveWire", R"(Cheapest paths along edges from one pixel (Mortensen and Barrett 1995).

Parameters
----------
edges : EdgeMap
seed : (int, int)
    Column, row.
reach : int
    Pixels farther than this from the seed along a row or column are not searched.
)");
    constructor(
        wire,
        [](const EdgeMap& map, const Position& seed, int reach) {
            if (reach < 1)
                throw Error(ErrorKind::invalid_input, "reach is " + std::to_string(reach) + "; at least 1 is needed");
            return std::make_unique<LiveWire>(map, pixel_of(map, seed),
                                              std::min(reach, std::max(map.width(), map.height())));
        },
        py::arg("edges"), py::arg("seed"), py::arg("reach") = 256, py::keep_alive<1, 2>());
    wire.def_property_readonly(
        "seed", [](const LiveWire& w) { return py::make_tuple(w.seed().column, w.seed().row); }, "(int, int): column, row.");
    method(
        wire, "path_to", R"(The pixels from the seed to a target, both included.

Parameters
----------
target : (int, int)
    Column, row; moved to the border when it lies beyond the slice or the reach.

Returns
-------
ndarray, shape (n, 2), int32
    Column and row of each.
)",
        [](LiveWire& self, const Position& target) {
            return path_array(self.path_to({target[0], target[1]}));
        },
        py::arg("target"));
    define(
        m, "smooth_path", R"(A path as a line: moved to the edge between the pixels, and smoothed over a pixel or two.

Parameters
----------
edges : EdgeMap
path : array_like, shape (n, 2)
    From `LiveWire.path_to`.

Returns
-------
ndarray, shape (m, 2), float64
    Column and row, to fractions of a pixel.
)",
        [](const EdgeMap& map, const ArrayOf<int>& path) {
            std::vector<PixelPosition> line = smooth_path(map, path_from(map, path));
            const auto count = static_cast<py::ssize_t>(line.size());
            return owning_array<PixelPosition, double>(std::move(line), {count, 2});
        },
        py::arg("edges"), py::arg("path"));
}

}  // namespace kontur::python
