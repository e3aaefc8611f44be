// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/bytes/png.h"
#include "kontur/view/picture.h"
#include "kontur/view/reslice.h"
#include "kontur/view/window.h"
#include "provenance.h"

namespace kontur::python {
namespace {

using WindowPair = std::pair<double, double>;
using Facts = std::vector<std::pair<std::string, std::string>>;

py::array pixels_of(RgbImage&& image) { return owning_array(std::move(image.bytes), {image.height, image.width, 3}); }

RgbImage image_from(const ArrayOf<std::uint8_t>& pixels) {
    if (pixels.ndim() != 3 || pixels.shape(2) != 3)
        throw Error(ErrorKind::invalid_input,
                    "a picture has the shape " + shape_text(pixels) + "; (height, width, 3) is needed");
    return {static_cast<int>(pixels.shape(1)),
            static_cast<int>(pixels.shape(0)),
            {pixels.data(), pixels.data() + pixels.size()}};
}

}  // namespace

void bind_pictures(py::module_& m) {
    const PictureOptions defaults;
    define(
        m, "make_picture", R"(One picture of a segmentation that is understood at once: the surface and three slices.

Parameters
----------
mesh : TriangleMesh or None
    None: a picture of the contours alone.
contours : ContourSet
image : Image, optional
    Without it the slices stand on a plain ground.
width_px, height_px : int
    At least 320 and 200.
title : str
    Empty: the contour set's name.
facts : sequence of (str, str)
    Captions and values below the figures that the picture gives by itself.
window : (float, float), optional
    Centre and width of the intensities from black to white; `suggest_window` when left out.
threads : int
    0: the machine's.

Returns
-------
ndarray, shape (height_px, width_px, 3), uint8
    sRGB, rows from top to bottom.
)",
        [](const TriangleMesh* mesh, const ContourSet& contours, const Image* image, int width_px, int height_px,
           const std::string& title, const Facts& facts, const std::optional<WindowPair>& window, int threads) {
            PictureOptions options{width_px, height_px, title, {}, {}, mesh != nullptr};
            for (const auto& [caption, value] : facts) options.facts.push_back({caption, value});
            if (window) options.window = Window{window->first, window->second};
            const TriangleMesh none;
            return pixels_of(
                unlocked([&] { return make_picture(mesh ? *mesh : none, contours, image, options, {.threads = threads}); }));
        },
        py::arg("mesh"), py::arg("contours"), py::arg("image") = py::none(), py::kw_only(),
        py::arg("width_px") = defaults.width_px, py::arg("height_px") = defaults.height_px, py::arg("title") = "",
        py::arg("facts") = py::tuple(), py::arg("window") = py::none(), kThreads);
    define(
        m, "write_png", "Writes pixels, shape (height, width, 3), uint8, as an sRGB PNG, whole or not at all.",
        [](const std::filesystem::path& path, const ArrayOf<std::uint8_t>& pixels, const py::object& items) {
            const RgbImage image = image_from(pixels);
            const Provenance provenance = provenance_from(items);
            const ReleasedLock released;
            write_png(path, image, provenance);
        },
        py::arg("path"), py::arg("pixels"), py::arg("provenance") = py::none());
    define(
        m, "encode_png", "The bytes of the file that `write_png` writes, for notebooks and mails.",
        [](const ArrayOf<std::uint8_t>& pixels, const py::object& items) {
            const RgbImage image = image_from(pixels);
            const Provenance provenance = provenance_from(items);
            return py::bytes(unlocked([&] { return encode_png(image, provenance); }));
        },
        py::arg("pixels"), py::arg("provenance") = py::none());
    define(
        m, "suggest_window", R"(The intensities that a screen shows from black to white: (centre, width).

CT soft tissue (40, 350) when the values look like Hounsfield units, else from the 1st to the 99th percentile.)",
        [](const Image& image) {
            const Window window = unlocked([&] { return suggest_window(image); });
            return WindowPair{window.center, window.width};
        },
        py::arg("image"));
    define(
        m, "reslice", R"(An image on a raster of square pixels in a plane.

Parameters
----------
image : Image
plane : Plane
    The raster's middle is at its origin; `u` runs to the right, `v` down.
width, height : int
    Pixels.
pixel_mm : float
outside : float
    The value beyond the outermost voxel centres by more than half a voxel.

Returns
-------
ndarray, shape (height, width), float32
)",
        [](const Image& image, const Plane& plane, int width, int height, double pixel_mm, float outside) {
            const Reslice raster = centered_reslice(plane, width, height, pixel_mm);
            return owning_array(unlocked([&] { return reslice(image, raster, outside); }), {height, width});
        },
        py::arg("image"), py::arg("plane"), py::arg("width"), py::arg("height"), py::arg("pixel_mm"), py::arg("outside"));
}

}  // namespace kontur::python
