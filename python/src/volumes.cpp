// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <limits>
#include <span>
#include <string_view>

#include "bindings.h"
#include "kontur/shape/volume.h"
#include "kontur/view/picture.h"

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
    const ArrayOf<Value> contiguous(values);
    return {contiguous.data(), contiguous.data() + contiguous.size()};
}

/// Throws Error(unsupported) for an array of anything but real numbers and booleans.
void check_type(const py::array& values, const char* what) {
    if (std::string_view("biuf").find(values.dtype().kind()) == std::string_view::npos)
        throw Error(ErrorKind::unsupported,
                    std::string(what) + " of type " + py::str(values.dtype()).cast<std::string>() + " are no real numbers");
}

/// Whether all values of an integer array fit into Value; an empty array never occurs.
template <class Value>
bool fits(const py::array& values) {
    const auto limit = [](auto number) { return py::int_(number); };
    return !(values.attr("min")() < limit(std::numeric_limits<Value>::min())) &&
           !(values.attr("max")() > limit(std::numeric_limits<Value>::max()));
}

/// Whether a whole number has at most the 24 binary digits of a float.
bool fits_float(std::uint64_t magnitude) { return magnitude == 0 || magnitude >> std::countr_zero(magnitude) < 1U << 24; }

/// Throws Error(unsupported) for a whole number that float would change.
template <class Whole>
void check_exact(const py::array& values) {
    const ArrayOf<Whole> wholes(values);
    for (const Whole value : std::span(wholes.data(), static_cast<std::size_t>(wholes.size()))) {
        const auto bits = static_cast<std::uint64_t>(value);
        if (!fits_float(value < 0 ? 0 - bits : bits))
            throw Error(ErrorKind::unsupported, "the sample " + std::to_string(value) +
                                                    " fits neither into 32-bit integers nor exactly into 32-bit floats");
    }
}

/// Throws Error(unsupported) for a finite number beyond the range of float.
void check_magnitude(const py::array& values) {
    const auto numpy = py::module_::import("numpy");
    const py::float_ most(std::numeric_limits<float>::max());
    const py::object beyond = numpy.attr("isfinite")(values) & numpy.attr("greater")(numpy.attr("abs")(values), most);
    if (py::bool_(beyond.attr("any")()))
        throw Error(ErrorKind::unsupported, py::str("the sample {} is beyond the range of 32-bit floats")
                                                .format(values[beyond][py::int_(0)])
                                                .cast<std::string>());
}

/// The array's own sample type where Image has it, else one that holds its values.
Image::Samples samples_from(const py::array& values) {
    if (py::isinstance<py::array_t<std::uint8_t>>(values) || py::isinstance<py::array_t<bool>>(values))
        return copied<std::uint8_t>(values);
    if (py::isinstance<py::array_t<std::int16_t>>(values)) return copied<std::int16_t>(values);
    if (py::isinstance<py::array_t<std::uint16_t>>(values)) return copied<std::uint16_t>(values);
    if (py::isinstance<py::array_t<std::int32_t>>(values)) return copied<std::int32_t>(values);
    check_type(values, "samples");
    const char kind = values.dtype().kind();
    if (kind == 'f') {
        if (values.itemsize() > static_cast<py::ssize_t>(sizeof(float))) check_magnitude(values);
        return copied<float>(values);
    }
    if (!fits<std::int32_t>(values)) {
        if (kind == 'i') check_exact<std::int64_t>(values);
        else check_exact<std::uint64_t>(values);
        return copied<float>(values);
    }
    if (fits<std::uint8_t>(values)) return copied<std::uint8_t>(values);
    if (fits<std::int16_t>(values)) return copied<std::int16_t>(values);
    if (fits<std::uint16_t>(values)) return copied<std::uint16_t>(values);
    return copied<std::int32_t>(values);
}

/// An array of the grid's shape. Throws Error(invalid_input).
py::array volume_from(const py::object& source, const Grid& grid) {
    const py::array values = array_from(source);
    if (!values) throw py::error_already_set();
    check_shape(values, grid);
    return values;
}

Image image_from(const py::object& samples, const Grid& grid) { return {grid, samples_from(volume_from(samples, grid))}; }

/// The floats as whole numbers, which keep them apart where 32-bit floats would not. Throws Error(invalid_input) for
/// fractions, NaN and infinity among them.
py::array wholes_of(const py::array& values) {
    const auto numpy = py::module_::import("numpy");
    const py::object fractions = numpy.attr("not_equal")(numpy.attr("trunc")(values), values) |
                                 numpy.attr("greater")(numpy.attr("abs")(values), 1e15);
    if (py::bool_(fractions.attr("any")()))
        throw Error(
            ErrorKind::invalid_input,
            py::str("the array is no mask and no label map: {} voxels hold values that are not integers, the first is {}; "
                    "compare it with a threshold (`array > 0.5`)")
                .format(fractions.attr("sum")(), values[fractions][py::int_(0)])
                .cast<std::string>());
    return values.attr("astype")("int64");
}

/// What `read_mask` makes of a file with these values; a lone value below 0 is more often a mark for something else.
Mask mask_from(const py::object& source, const Grid& grid, std::optional<std::int64_t> label) {
    py::array values = volume_from(source, grid);
    check_type(values, "mask values");
    if (values.dtype().kind() == 'f') values = wholes_of(values);
    if (const py::int_ least(values.attr("min")()); !label && least < py::int_(0))
        throw Error(ErrorKind::invalid_input,
                    py::str("the array has the value {}; a mask holds 0 and one value above it, or choose "
                            "one with the option label")
                        .format(least)
                        .cast<std::string>());
    return select_mask({grid, samples_from(values)}, label, "the array");
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

double volume_ml(const Mask& mask) {
    const auto inside = mask.values.size() - std::count(mask.values.begin(), mask.values.end(), std::uint8_t{0});
    return static_cast<double>(inside) * mask.grid.voxel_volume_mm3() / 1000;
}

void bind_mask(py::module_& m) {
    py::class_<Mask> mask(m, "Mask", R"(A binary mask on a grid. numpy.asarray(mask) is its array.

Parameters
----------
values : array_like, shape (z, y, x)
    Booleans, or whole numbers of which at most one is not 0: inside where not 0; copied. Label maps with several labels need
    `label`; probabilities and other fractions are refused, and so are numbers below 0 without `label`.
grid : Grid
label : int, optional
    Inside where `values` has this value, which must be there.

Examples
--------
>>> grid = kontur.Grid((4, 3, 2), np.eye(4), frame="LPS")
>>> mask = kontur.Mask(np.arange(24).reshape(2, 3, 4) > 20, grid)
>>> mask.values.sum(), mask.volume_ml
(3, 0.003)
>>> organs = np.arange(24).reshape(2, 3, 4) // 8
>>> kontur.Mask(organs, grid, label=2).values.sum()
8
)");
    constructor(mask, &mask_from, py::arg("values"), py::arg("grid"), py::arg("label") = py::none());
    mask.def_readonly("grid", &Mask::grid, "Grid");
    mask.def_property_readonly(
        "values", &mask_values,
        "ndarray, shape (z, y, x), uint8: 0 outside, 1 inside. A view: writing to it changes the mask.");
    mask.def_property_readonly("volume_ml", &volume_ml, "float");
    define_array(mask, &mask_values);
    mask.def("__repr__", [](const Mask& self) {
        return py::str("<Mask of {} on {!r}>").format(in_ml(volume_ml(self)), py::cast(self.grid));
    });
    // Not by way of the constructor: whatever was written into the array comes back.
    mask.def(py::pickle([](const py::object& self) { return py::make_tuple(mask_values(self), self.attr("grid")); },
                        [](const py::tuple& state) {
                            const auto grid = state[1].cast<Grid>();
                            return Mask{grid, copied<std::uint8_t>(volume_from(state[0], grid))};
                        }));
}

void bind_image(py::module_& m) {
    py::class_<Image> image(m, "Image", R"(A scalar image (CT, MR, label map) on a grid. numpy.asarray(image) is its array.

Parameters
----------
samples : array_like, shape (z, y, x)
    Copied as uint8, int16, uint16, int32 or float32: its own type where it is one of these, else the first that holds all values;
    64-bit floats become float32. Integers that none of them holds and floats beyond float32 are refused.
grid : Grid

Examples
--------
>>> image = kontur.Image(np.full((2, 3, 4), -1000), kontur.Grid((4, 3, 2), np.eye(4), frame="LPS"))
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
