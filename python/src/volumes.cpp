// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "bindings.h"
#include "kontur/shape/volume.h"

namespace kontur::python {
namespace {

void check_shape(const py::array& values, const Grid& grid) {
    const auto shape = array_shape(grid);
    if (values.ndim() == 3 && std::equal(shape.begin(), shape.end(), values.shape())) return;
    throw Error(ErrorKind::invalid_input, "the array has the shape " + shape_text(values) + "; the grid's (z, y, x) is (" +
                                              std::to_string(shape[0]) + ", " + std::to_string(shape[1]) + ", " +
                                              std::to_string(shape[2]) + ")");
}

template <class Value>
std::vector<Value> copied(const py::array& values) {
    const auto contiguous = ArrayOf<Value>::ensure(values);
    if (!contiguous) throw py::error_already_set();
    return {contiguous.data(), contiguous.data() + contiguous.size()};
}

Mask mask_from(const py::array& values, const Grid& grid) {
    check_shape(values, grid);
    return {grid, copied<std::uint8_t>(values.attr("__ne__")(0))};
}

/// Whether all values of an integer array fit into Value; an empty array never occurs.
template <class Value>
bool fits(const py::array& values) {
    const auto limit = [](auto number) { return py::int_(number); };
    return !(values.attr("min")() < limit(std::numeric_limits<Value>::min())) &&
           !(values.attr("max")() > limit(std::numeric_limits<Value>::max()));
}

/// The array's own sample type where Image has it, else one that holds its values.
Image::Samples samples_from(const py::array& values) {
    if (py::isinstance<py::array_t<std::uint8_t>>(values) || py::isinstance<py::array_t<bool>>(values))
        return copied<std::uint8_t>(values);
    if (py::isinstance<py::array_t<std::int16_t>>(values)) return copied<std::int16_t>(values);
    if (py::isinstance<py::array_t<std::uint16_t>>(values)) return copied<std::uint16_t>(values);
    if (py::isinstance<py::array_t<std::int32_t>>(values)) return copied<std::int32_t>(values);
    const char kind = values.dtype().kind();
    if (kind != 'i' && kind != 'u' && kind != 'f')
        throw Error(ErrorKind::unsupported,
                    "samples of type " + py::str(values.dtype()).cast<std::string>() + " are no real numbers");
    if (kind == 'f' || !fits<std::int32_t>(values)) return copied<float>(values);
    if (fits<std::uint8_t>(values)) return copied<std::uint8_t>(values);
    if (fits<std::int16_t>(values)) return copied<std::int16_t>(values);
    if (fits<std::uint16_t>(values)) return copied<std::uint16_t>(values);
    return copied<std::int32_t>(values);
}

Image image_from(const py::array& samples, const Grid& grid) {
    check_shape(samples, grid);
    return {grid, samples_from(samples)};
}

py::array mask_values(const py::object& self) {
    const Mask& mask = self.cast<const Mask&>();
    return array_view(mask.values.data(), array_shape(mask.grid), self);
}

py::array image_samples(const py::object& self) {
    const Image& image = self.cast<const Image&>();
    return std::visit(
        [&](const auto& samples) -> py::array { return array_view(samples.data(), array_shape(image.grid), self); },
        image.samples);
}

/// numpy.asarray(volume)
template <class Class>
void define_array(Class& type, py::array (*array)(const py::object&)) {
    type.def(
        "__array__",
        [array](const py::object& self, const py::object& dtype) -> py::object {
            const py::object values = array(self);
            return dtype.is_none() ? values : values.attr("astype")(dtype, py::arg("copy") = false);
        },
        py::arg("dtype") = py::none());
}

void bind_mask(py::module_& m) {
    py::class_<Mask> mask(m, "Mask", R"(A binary mask on a grid. numpy.asarray(mask) is its array.

Parameters
----------
values : array_like, shape (z, y, x)
    Inside where not 0; copied.
grid : Grid

Examples
--------
>>> grid = kontur.Grid((4, 3, 2), np.eye(4))
>>> mask = kontur.Mask(np.arange(24).reshape(2, 3, 4) > 20, grid)
>>> mask.values.sum(), mask.volume_ml
(3, 0.003)
)");
    constructor(mask, &mask_from, py::arg("values"), py::arg("grid"));
    mask.def_readonly("grid", &Mask::grid, "Grid");
    mask.def_property_readonly(
        "values", &mask_values,
        "ndarray, shape (z, y, x), uint8: 0 outside, 1 inside. A view: writing to it changes the mask.");
    mask.def_property_readonly(
        "volume_ml",
        [](const Mask& self) {
            const auto inside = self.values.size() - std::count(self.values.begin(), self.values.end(), std::uint8_t{0});
            return static_cast<double>(inside) * self.grid.voxel_volume_mm3() / 1000;
        },
        "float");
    define_array(mask, &mask_values);
    mask.def("__repr__", [](const py::object& self) { return py::str("<Mask on {!r}>").format(self.attr("grid")); });
    mask.def("__reduce__", [](const py::object& self) {
        return py::make_tuple(py::type::of(self), py::make_tuple(mask_values(self), self.attr("grid")));
    });
}

void bind_image(py::module_& m) {
    py::class_<Image> image(m, "Image", R"(A scalar image (CT, MR, label map) on a grid. numpy.asarray(image) is its array.

Parameters
----------
samples : array_like, shape (z, y, x)
    Copied as uint8, int16, uint16, int32 or float32: its own type where it is one of these, else the first that holds all values;
    64-bit floats become float32.
grid : Grid

Examples
--------
>>> image = kontur.Image(np.full((2, 3, 4), -1000), kontur.Grid((4, 3, 2), np.eye(4)))
>>> image.samples.dtype
dtype('int16')
)");
    constructor(image, &image_from, py::arg("samples"), py::arg("grid"));
    image.def_readonly("grid", &Image::grid, "Grid");
    image.def_property_readonly(
        "samples", &image_samples,
        "ndarray, shape (z, y, x): intensities, rescaled (Hounsfield units for CT). A view: writing to it "
        "changes the image.");
    define_array(image, &image_samples);
    image.def("__repr__", [](const py::object& self) {
        return py::str("<Image of {} on {!r}>").format(image_samples(self).dtype(), self.attr("grid"));
    });
    image.def("__reduce__", [](const py::object& self) {
        return py::make_tuple(py::type::of(self), py::make_tuple(image_samples(self), self.attr("grid")));
    });
}

}  // namespace

void bind_volumes(py::module_& m) {
    bind_mask(m);
    bind_image(m);

    define(
        m, "interpolate", R"(Trilinear interpolation of an image.

Parameters
----------
image : Image
points : array_like, shape (n, 3)
    mm (LPS).
outside : float
    The value beyond the outermost voxel centres by more than half a voxel.

Returns
-------
ndarray, shape (n,), float64
)",
        [](const Image& image, const ArrayOf<double>& points, double outside) {
            const auto targets = points_of(points);
            std::vector<double> values(targets.size());
            unlocked([&] {
                const Affine3 mm_to_index = image.grid.index_to_mm.inverse();
                std::transform(targets.begin(), targets.end(), values.begin(),
                               [&](const Vec3& p) { return interpolate(image, mm_to_index, p, outside); });
                return 0;
            });
            const auto count = static_cast<py::ssize_t>(values.size());
            return owning_array(std::move(values), {count});
        },
        py::arg("image"), py::arg("points"), py::arg("outside"));
    define(
        m, "select_label", "The Mask of the voxels with exactly this value.",
        [](const Image& image, double label) { return unlocked([&] { return select_label(image, label); }); },
        py::arg("image"), py::arg("label"));
    define(
        m, "select_nonzero", "The Mask of the voxels with a value other than 0.",
        [](const Image& image) { return unlocked([&] { return select_nonzero(image); }); }, py::arg("image"));
    define(
        m, "count_labels",
        "Voxel count of every value except 0: dict of int to int. Raises InvalidInputError for no label map.",
        [](const Image& image, std::size_t max_labels) { return unlocked([&] { return count_labels(image, max_labels); }); },
        py::arg("image"), py::arg("max_labels") = 4096);
}

}  // namespace kontur::python
