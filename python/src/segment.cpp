// SPDX-License-Identifier: Apache-2.0
#include "kontur/segment.h"

#include "bindings.h"
#include "fields.h"
#include "kontur/base/counted.h"
#include "kontur/segment_report.h"
#include "kontur/view/picture.h"
#include "provenance.h"
#include "segment_keywords.h"
#include "segment_words.h"

namespace kontur::python {
namespace {

void bind_json(py::class_<SegmentReport>& type) {
    method(
        type, "to_json", R"(The report as `kontur segment --report` writes it: JSON of several lines.

Contours are counted from 1. `peak_memory_mb` is that of this process until now.

Parameters
----------
provenance : dict of str to str, optional
    What `provenance` gives; empty when left out.

Returns
-------
str
)",
        [](const SegmentReport& report, const py::object& made) { return to_json(report, provenance_from(made)); },
        py::arg("provenance") = py::none());
    method(
        type, "to_dict", R"(The same as a dict.

Parameters
----------
provenance : dict of str to str, optional

Returns
-------
dict

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> report = kontur.segment(case.contours, case.grid).report.to_dict()
>>> report["contours"], report["mask"]["components"]
(6, 1)
)",
        [](const SegmentReport& report, const py::object& made) -> py::dict {
            return py::module_::import("json").attr("loads")(to_json(report, provenance_from(made)));
        },
        py::arg("provenance") = py::none());
}

py::object mesh_of(const py::object& self) {
    const auto& mesh = self.cast<const Segmentation&>().mesh;
    if (!mesh) return py::none();
    return py::cast(&*mesh, py::return_value_policy::reference_internal, self);
}

void bind_image_report(py::module_& m) {
    py::class_<ImageShare> share(m, "ImageShare", "A place of the surface at which the image was asked.");
    Fields(share)
        .field("position", &ImageShare::position, "ndarray, shape (3,): mm.")
        .field("share", &ImageShare::share, "float: of the error without the image that it leaves, 0 to 1.")
        .picklable();
    py::class_<ImageReport> type(m, "ImageReport", "What became of the image between the contours.");
    Fields(type)
        .field("verdict", &ImageReport::verdict,
               "str: 'none' (no image, or not asked for), 'labels' (a mask or label map), 'unknown' (too few planes to "
               "tell), 'no_help' and 'astray' (not used) or 'used'.")
        .field("planes_left_out", &ImageReport::planes_left_out, "int: one after another, to see whether the image helps.")
        .field("error_without_mm", &ImageReport::error_without_mm,
               "float: mean distance of contours left out from the surface through the others.")
        .field("error_with_mm", &ImageReport::error_with_mm, "float: the same with the image.")
        .field("displaced", &ImageReport::displaced,
               "bool: the errors are those of a surface displaced at the contours on purpose, where leaving planes out did "
               "not show that the image helps.")
        .field("walked", &ImageReport::walked,
               "bool: the surface follows a random walk on the image's voxels, which finds branches that no contour shows.")
        .field("weight", &ImageReport::weight,
               "float: how far what the image shows is followed, 0 to 1: the walk, or else the movement.")
        .field("wrong_without", &ImageReport::wrong_without,
               "float: voxels of planes left out on the wrong side of the surface through the others, over those inside; 0 "
               "where no walk was used or tried.")
        .field("wrong_with", &ImageReport::wrong_with, "float: the same with the walk.")
        .field("largest_move_mm", &ImageReport::largest_move_mm, "float: of the surface.")
        .field("intensities", &ImageReport::intensities, "int: read from the image.")
        .field("on_contours_mm", &ImageReport::on_contours_mm, "float: the largest change of f at any drawn point.")
        .field("shares", &ImageReport::shares, "list of ImageShare: where the image was asked.")
        .picklable();
    type.def("__str__", [](const ImageReport& report) { return sentence(report); });
}

void bind_report(py::module_& m) {
    using Report = SegmentReport;
    py::class_<Report> type(m, "SegmentReport", "What `segment` did, and how well the surface fits.");
    Fields fields(type);
    fields.field("contours", &Report::contours, "int")
        .field("points", &Report::points, "int: drawn points.")
        .field("constraints", &Report::constraints, "int: placed and kept.")
        .field("merged", &Report::merged, "int: constraints left out because others are close by.")
        .field("bounded", &Report::bounded, "int: bounds at which f is held: outside in a drawn plane, or beyond an end.")
        .field("centres", &Report::centres, "int: weights of the implicit function.")
        .field("kernel", &Report::kernel, "str")
        .field("normals", &Report::normals, "str")
        .field("normal_offset_mm", &Report::normal_offset_mm, "float: as used.")
        .field("smoothing", &Report::smoothing, "float: as used.")
        .field("tolerance_mm", &Report::tolerance_mm, "float: of the iterative solver, as used.")
        .field("conflicts", &Report::conflicts, "str")
        .field("corners", &Report::corners, "str")
        .field("fill_rule", &Report::fill_rule, "str")
        .field("quality", &Report::quality, "float")
        .field("solver", &Report::solver, "str: the one that ran.")
        .field("voxelizer", &Report::voxelizer, "str")
        .field("use_image", &Report::use_image, "str")
        .field("image", &Report::image, "ImageReport: what became of the image between the contours.")
        .field("solves", &Report::solves, "int")
        .field("iterations", &Report::iterations, "int: over all solves; 0 for direct solvers.")
        .field("residual", &Report::residual, "Residual: at all drawn points.")
        .field("crossings", &Report::crossings,
               "list of Crossing: contours of different planes, those that disagree most first.")
        .field("section_check", &Report::section_check, "SectionCheck: the result against its own drawing.")
        .field(
            "near_lines", &Report::near_lines,
            "list of NearLines: lines of one plane that count as one or leave a thin wall, with indices of what was drawn.")
        .field("evaluations", &Report::evaluations, "int: function values computed to voxelize.")
        .field("surface_voxels", &Report::surface_voxels, "int: lattice cells that the surface passes through.")
        .field("mask_voxels", &Report::mask_voxels, "int")
        .field("mask_volume_ml", &Report::mask_volume_ml, "float")
        .field("mask_components", &Report::mask_components, "int: face-connected.")
        .field("uncertainty", &Report::uncertainty, "SurfaceUncertainty: what the contours say of the surface's error.")
        .field("estimated_memory_mb", &Report::estimated_memory_mb, "float: before the fit, of the whole process.")
        .field("warnings", &Report::warnings, "list of str: choices made for you and doubts, one sentence each.")
        .stored("seconds", &Report::seconds)
        .picklable();
    type.def_property_readonly(
        "seconds", [](const Report& report) { return py::dict(py::cast(report.seconds)); },
        "dict of str to float: wall time by stage.");
    type.def("__repr__", [](const Report& report) {
        return py::str("<SegmentReport: {}, {}, {}, residual {:.3g} mm (max), {:.3g} mm (rms), {}>")
            .format(counted(report.contours, "contour"), counted(report.points, "point"), in_ml(report.mask_volume_ml),
                    report.residual.max_mm, report.residual.rms_mm, counted(report.warnings.size(), "warning"));
    });
    bind_json(type);
}

void bind_segmentation(py::module_& m) {
    py::class_<Segmentation> type(m, "Segmentation", "What `segment` made.");
    type.def_readonly("mask", &Segmentation::mask, "Mask");
    type.def_readonly("function", &Segmentation::function, "ImplicitFunction: f > 0 inside.");
    type.def_property_readonly("mesh", &mesh_of, "TriangleMesh, or None when it was not asked for.");
    type.def_readonly("report", &Segmentation::report, "SegmentReport");
    type.def("__repr__", [](const Segmentation& s) {
        const std::string triangles = s.mesh ? ", " + std::to_string(s.mesh->triangles.size()) + " triangles" : "";
        return py::str("<Segmentation: {}{}, residual {:.3g} mm (max)>")
            .format(in_ml(s.report.mask_volume_ml), triangles, s.report.residual.max_mm);
    });
    type.def(py::pickle(
        [](const py::object& self) {
            const auto& samples = self.cast<const Segmentation&>().samples;
            return py::make_tuple(self.attr("mask"), self.attr("function"), self.attr("mesh"), self.attr("report"),
                                  samples.points, samples.areas_mm2, samples.slopes);
        },
        [](const py::tuple& state) {
            return Segmentation{state[0].cast<Mask>(), state[1].cast<ImplicitFunction>(),
                                state[2].cast<std::optional<TriangleMesh>>(), state[3].cast<SegmentReport>(),
                                SurfaceSamples{state[4].cast<std::vector<Vec3>>(), state[5].cast<std::vector<double>>(),
                                               state[6].cast<std::vector<double>>()}};
        }));
}

}  // namespace

Keywords<SegmentOptions> segment_keywords() {
    return Keywords<SegmentOptions>()
        .field("kernel", &SegmentOptions::kernel, "Radial function: r^3 that goes back to a mean outside, r^3 or r.")
        .field("normals", &SegmentOptions::normals,
               "Direction of the surface at a contour: from all contours together, or the contour's alone (the paper's).")
        .field("normal_offset_mm", &SegmentOptions::normal_offset_mm,
               "Length of the normal constraints; None: 1.35 % of the contours' diameter, in-plane normals 0.45 %.")
        .field("smoothing", &SegmentOptions::smoothing,
               "On unit coordinates; 0 passes through every point; None: 1e-5 with surface normals, else 0.")
        .field("conflicts", &SegmentOptions::conflicts,
               "Where contours of different planes contradict each other: both yield, the earlier one, or none.")
        .field("fill_rule", &SegmentOptions::fill_rule, "What contours inside others of their plane mean.")
        .field("corners", &SegmentOptions::corners,
               "Points at which a contour turns by 30 degrees or more: passed in a narrow bend, or followed into.")
        .field("quality", &SegmentOptions::quality, "Fraction of each contour's points that the fit uses, in (0, 1].")
        .field("solver", &SegmentOptions::solver, "'automatic' is iterative; 'dense' is LAPACK's dsysv, the paper's.")
        .field("tolerance_mm", &SegmentOptions::tolerance_mm,
               "Of the iterative solver, at all constraints; None: 1.5e-5 of the contours' diameter.")
        .field("voxelizer", &SegmentOptions::voxelizer,
               "Follow the surface from the contours, computing values where needed or at every voxel it passes; or compute "
               "all voxels.")
        .field("use_image", &SegmentOptions::use_image,
               "'auto': where an image is given, let it tell how the surface runs between the contours, if it is shown, at "
               "contours left out, that this helps.")
        .field("mesh", &SegmentOptions::mesh, "Also make the surface.")
        .field("drawn_on", &SegmentOptions::drawn_on,
               "Grid of what was drawn on, where no image is given: the object goes on where its border cuts it off.")
        .field("max_memory_mb", &SegmentOptions::max_memory_mb,
               "Refuse a run of which the process would hold more; None: the machine's memory.");
}

void bind_segment(py::module_& m) {
    bind_image_report(m);
    bind_report(m);
    bind_segmentation(m);

    const auto keywords = segment_keywords();
    define(
        m, "segment", R"(Contours to mask (and surface) on a grid.

The same bytes for any number of threads, and the same as the command line's. Other Python threads run meanwhile.

Parameters
----------
contours : ContourSet
grid : Grid
    Such as `image.grid`.
image : Image, optional
    What was drawn on, for `use_image`.
@threads
progress : callable, optional
    Called now and then on this thread with the stage's name and its done fraction from 0 to 1. An exception that it raises
    stops the work and is raised from here.
stop : object with is_set(), optional
    Such as a threading.Event, to cancel from another thread: CancelledError. Ctrl-C cancels as well: KeyboardInterrupt.
@options

Returns
-------
Segmentation

Raises
------
InvalidInputError
    For contours or options that cannot be used; the message names the contour, the number and the limit.
SingularSystemError, TooLargeError, CancelledError

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> kidney = kontur.segment(case.contours, case.grid, mesh=True)
>>> kidney.mask.values.shape == case.grid.shape
True
>>> kontur.topology(kidney.mesh).closed
True
>>> kidney.report.residual.max_mm < 0.5
True
)",
        [keywords](const ContourSet& contours, const Grid& grid, const Image* image, int threads, const py::object& progress,
                   const py::object& stop, const py::kwargs& given) {
            const SegmentOptions options = keywords.parse("segment", given);
            return run({progress, stop, threads},
                       [&](const Work& work) { return segment(contours, grid, image, options, work); });
        },
        py::arg("contours"), py::arg("grid"), py::kw_only(), py::arg("image") = py::none(), kThreads, kProgress, kStop,
        KeywordText(keywords));
    define(
        m, "provenance", R"(What determines a result, for `write_mask` and `write_mesh`.

Parameters
----------
contours : ContourSet
grid : Grid
report : SegmentReport
    What `segment` reported for them.

Returns
-------
dict of str to str
    Digests of contours and grid, version, options as used. Neither time nor file names; add what else you want to keep.

Examples
--------
>>> case = kontur.phantom_case("kidney_radial6")
>>> made = kontur.provenance(case.contours, case.grid, kontur.segment(case.contours, case.grid).report)
>>> list(made), len(made["contours_sha256"])
(['contours_sha256', 'grid_sha256', 'version', 'options'], 64)
)",
        [](const ContourSet& contours, const Grid& grid, const SegmentReport& report) {
            py::dict made;
            for (const auto& [name, value] : provenance(contours, grid, report)) made[py::str(name)] = value;
            return made;
        },
        py::arg("contours"), py::arg("grid"), py::arg("report"));
}

}  // namespace kontur::python
