// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>

#include "bindings.h"
#include "fields.h"
#include "kontur/base/checks.h"
#include "kontur/fill_labels.h"
#include "run.h"
#include "segment_words.h"

namespace kontur::python {

template <>
struct Words<FillEnds> {
    static constexpr std::array values{FillEnds::closed, FillEnds::half, FillEnds::open};
};

namespace {

Keywords<FillOptions> fill_keywords() {
    return Keywords<FillOptions>()
        .field("ends", &FillOptions::ends,
               "How far beyond the first and the last of parallel slices: not at all, half of a gap, or as far as the fit "
               "says.")
        .field("jointly", &FillOptions::jointly,
               "Take labels that touch also as one object, so that no gaps stay between them.")
        .field("shape_weight", &FillOptions::shape_weight,
               "Share of the shape-based interpolation beside the fit, between parallel slices; 0: the fit alone.")
        .field("use_image", &FillOptions::use_image,
               "'auto': where an image is given, let it tell how the surface runs between the slices, if it is shown, at "
               "slices left out, that this helps.")
        .field("smoothing_voxels", &FillOptions::smoothing_voxels, "Of the painted outlines, standard deviation in voxels.")
        .field("only", &FillOptions::labels, "Only these labels; empty: all.")
        .field("max_memory_mb", &FillOptions::max_memory_mb,
               "Refuse a run of which the process would hold more; None: the machine's memory.");
}

/// Of an array: its axes are those of the grid, last one first.
Grid grid_of(const py::array& array, const std::array<double, 3>& spacing_mm) {
    if (array.ndim() != 3)
        throw Error(ErrorKind::invalid_input, "the array has " + std::to_string(array.ndim()) + " axes; a label map has 3");
    Grid grid{{array.shape(2), array.shape(1), array.shape(0)}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const double spacing = spacing_mm[static_cast<std::size_t>(2 - axis)];
        check_above_0("the spacing along axis " + std::to_string(2 - axis), spacing, " mm");
        Vec3 step;
        step[axis] = spacing;
        grid.index_to_mm.set_column(axis, step);
    }
    return grid;
}

void bind_report(py::module_& m) {
    py::class_<FilledLabel> label(m, "FilledLabel", "What became of one label.");
    Fields(label)
        .field("label", &FilledLabel::label, "int")
        .field("slices", &FilledLabel::slices, "list of 3 int: painted ones across the grid's axes i, j and k.")
        .field("painted_voxels", &FilledLabel::painted_voxels, "int")
        .field("added_voxels", &FilledLabel::added_voxels, "int")
        .field("image", &FilledLabel::image, "ImageReport: what became of the image between the slices.")
        .field("warnings", &FilledLabel::warnings, "list of str: one sentence each.")
        .picklable();
    py::class_<FillReport> report(m, "FillReport", "What `fill_labels` did.");
    Fields(report)
        .field("labels", &FillReport::labels, "list of FilledLabel: in increasing order.")
        .field("contested_voxels", &FillReport::contested_voxels, "int: claimed by more than one label.")
        .field("closed_voxels", &FillReport::closed_voxels,
               "int: between labels that touch, claimed by them together alone.")
        .stored("seconds", &FillReport::seconds)
        .picklable();
    report.def_property_readonly(
        "seconds", [](const FillReport& r) { return py::dict(py::cast(r.seconds)); },
        "dict of str to float: wall time by stage.");
}

}  // namespace

void bind_labels(py::module_& m) {
    bind_report(m);
    const auto keywords = fill_keywords();
    define(
        m, "fill_labels", R"(Fills what was left out of a label map of which some slices are painted.

Each label is painted on some slices, across any axis of the array or several; what was painted stays as it is. Other Python
threads run meanwhile.

Parameters
----------
labels : array_like of whole numbers, shape (z, y, x), or Image
    0 where nothing is painted.
spacing : (float, float, float), optional
    Distance of the voxels in mm along the array's axes, in their order; an Image has its own.
image : Image, optional
    What was painted on, for `use_image`, on any grid of the same frame; an array of labels lies at the origin.
return_report : bool
    Also return the FillReport.
@threads
@progress
@options

Returns
-------
numpy.ndarray of the same type and shape, or Image
    With `return_report` a pair of it and the FillReport.

Raises
------
InvalidInputError
    For an array that is no label map, a label that is not in it, or an array without `spacing`.
TooLargeError, CancelledError

Examples
--------
>>> z, y, x = np.mgrid[:41, :40, :40]
>>> ball = ((z - 20) ** 2 + (y - 20) ** 2 + (x - 20) ** 2 < 15**2).astype("uint8")
>>> sparse = np.where(z % 4 == 2, ball, 0)
>>> full = kontur.fill_labels(sparse, (1, 1, 1))
>>> bool(2 * (full & ball).sum() / (full.sum() + ball.sum()) > 0.97)
True
)",
        [keywords](const py::object& labels, const std::optional<std::array<double, 3>>& spacing, const Image* reference,
                   bool return_report, int threads, const py::object& progress, const py::object& stop,
                   const py::kwargs& given) -> py::object {
            const FillOptions options = keywords.parse("fill_labels", given);
            const bool is_image = py::isinstance<Image>(labels);
            if (is_image && spacing)
                throw Error(ErrorKind::invalid_input, "an Image has its own spacing; leave `spacing` out");
            if (!is_image && !spacing)
                throw Error(ErrorKind::invalid_input,
                            "an array has no spacing; give that of its voxels in mm, such as (5, 1, 1)");
            const py::array array = is_image ? py::array() : array_from(labels);
            if (!array) throw py::error_already_set();
            Image image =
                is_image
                    ? labels.cast<const Image&>()
                    : py::module_::import("kontur").attr("Image")(array, py::cast(grid_of(array, *spacing))).cast<Image>();
            Filling filling = run({progress, stop, threads},
                                  [&](const Work& work) { return fill_labels(std::move(image), reference, options, work); });
            FillReport report = std::move(filling.report);
            py::object full = py::cast(std::move(filling.labels));
            if (!is_image) full = full.attr("samples").attr("astype")(array.dtype());
            if (return_report) return py::make_tuple(full, report);
            return full;
        },
        py::arg("labels"), py::arg("spacing") = py::none(), py::kw_only(), py::arg("image") = py::none(),
        py::arg("return_report") = false, kThreads, kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
