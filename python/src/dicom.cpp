// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/dicom/dicom_phases.h"
#include "kontur/io/dicom/dicom_series.h"
#include "kontur/io/dicom/rtstruct.h"
#include "kontur/io/dicom/rtstruct_in_time.h"
#include "notes.h"
#include "provenance.h"
#include "roi_name.h"

namespace kontur::python {
namespace {

namespace fs = std::filesystem;

Keywords<DicomSeriesOptions> series_keywords() {
    return Keywords<DicomSeriesOptions>()
        .field("series_uid", &DicomSeriesOptions::series_uid, "Which series; may be left out when there is only one.")
        .field("volume", &DicomSeriesOptions::volume, "Which volume of the series, from 1; likewise.")
        .field("max_voxels", &DicomSeriesOptions::max_voxels, "Larger volumes are refused.");
}

void bind_series(py::module_& m) {
    py::class_<DicomSeries> series(m, "DicomSeries", "One volume found in a folder of DICOM files.");
    series.def_readonly("series_uid", &DicomSeries::series_uid, "str");
    series.def_readonly("modality", &DicomSeries::modality, "str: 'CT', 'MR', ...");
    series.def_readonly("description", &DicomSeries::description, "str: may be empty.");
    series.def_readonly("distinction", &DicomSeries::distinction,
                        "str: what sets this volume apart from others of the series, such as 'echo 2'; else empty.");
    series.def_readonly("frame_of_reference_uid", &DicomSeries::frame_of_reference_uid, "str");
    series.def_readonly("files", &DicomSeries::files, "list of pathlib.Path: one for each slice, in the order of k.");
    series.def_readonly("columns", &DicomSeries::columns, "int");
    series.def_readonly("rows", &DicomSeries::rows, "int");
    series.def("__repr__", [](const DicomSeries& s) {
        return py::str("<DicomSeries {} {!r}: {} slices>").format(s.modality, s.description, s.files.size());
    });

    py::class_<DicomVolume> volume(m, "DicomVolume", "A DICOM volume with what was decided on the way.");
    volume.def_readonly("image", &DicomVolume::image, "Image: modality units (Hounsfield units for CT).");
    volume.def_readonly("series", &DicomVolume::series, "DicomSeries");
    volume.def_readonly("notes", &DicomVolume::notes, "list of str: gantry tilt, files left out, ...");
    volume.def_readonly(
        "warnings", &DicomVolume::warnings,
        "list of str: what may be wrong with it, such as files that could be slices of it and cannot be read.");
    py::class_<DicomGrid> grid(m, "DicomGrid", "The same without voxels.");
    grid.def_readonly("grid", &DicomGrid::grid, "Grid");
    grid.def_readonly("series", &DicomGrid::series, "DicomSeries");
    grid.def_readonly("notes", &DicomGrid::notes, "list of str");
    grid.def_readonly("warnings", &DicomGrid::warnings, "list of str");
}

Roi roi_from(ContourSet contours, std::string name, const std::optional<std::array<std::uint8_t, 3>>& color,
             std::string interpreted_type, std::string generation_algorithm, std::int64_t number) {
    Roi roi;
    roi.number = number;
    roi.name = std::move(name);
    roi.contours = std::move(contours);
    StructureAttributes& attributes = roi.contours.attributes;
    if (!interpreted_type.empty()) attributes.interpreted_type = std::move(interpreted_type);
    if (!generation_algorithm.empty()) attributes.generation_algorithm = std::move(generation_algorithm);
    if (color) attributes.color = color;
    return roi;
}

void bind_structures(py::module_& m) {
    py::class_<Roi> roi(m, "Roi", R"(One region of interest of an RT structure set.

Parameters
----------
contours : ContourSet
name : str
    Empty: the contour set's name.
color : (int, int, int), optional
    Red, green, blue, 0 to 255. Here and in the next two: what is left out, or empty, is that of ``contours.attributes``.
interpreted_type : str
    'ORGAN', 'GTV', ...
generation_algorithm : {'', 'AUTOMATIC', 'SEMIAUTOMATIC', 'MANUAL'}
number : int
    0: that of ``contours.attributes``, else the next free one.
)");
    constructor(roi, &roi_from, py::arg("contours"), py::arg("name") = "", py::arg("color") = py::none(),
                py::arg("interpreted_type") = "", py::arg("generation_algorithm") = "", py::arg("number") = 0);
    roi.def_property_readonly(
        "generation_algorithm", [](const Roi& r) { return r.contours.attributes.generation_algorithm; },
        "str: may be empty.");
    roi.def_readonly("number", &Roi::number, "int");
    roi.def_readonly("name", &Roi::name, "str");
    roi.def_property_readonly(
        "interpreted_type", [](const Roi& r) { return r.contours.attributes.interpreted_type; },
        "str: 'GTV', 'ORGAN', ...; may be empty.");
    roi.def_readonly("frame_of_reference_uid", &Roi::frame_of_reference_uid, "str");
    roi.def_property_readonly(
        "color", [](const Roi& r) { return r.contours.attributes.color; },
        "list of 3 int (red, green, blue, 0 to 255), or None.");
    roi.def_readonly("contours", &Roi::contours,
                     "ContourSet: may be empty; what else the file says of the ROI is in its attributes.");
    roi.def_readonly("notes", &Roi::notes, "list of str: how the stored contours were interpreted.");
    roi.def_readonly("damage", &Roi::damage, "str: why its contours cannot be read; empty when they can.");
    roi.def("__repr__", [](const Roi& r) { return py::str("<Roi {}: {!r}>").format(r.number, r.name); });

    py::class_<StructureSet> set(m, "StructureSet", R"(An RT structure set.

Parameters
----------
rois : sequence of Roi
label : str
)");
    constructor(
        set,
        [](std::vector<Roi> rois, std::string label) {
            return StructureSet{std::move(label), std::move(rois), {}};
        },
        py::arg("rois"), py::arg("label") = "");
    set.def_readonly("label", &StructureSet::label, "str");
    set.def_readonly("rois", &StructureSet::rois, "list of Roi: in the file's order.");
    set.def_readonly("notes", &StructureSet::notes, "list of str: what was left out that belongs to no ROI.");

    define(m, "is_rtstruct", "Whether a file is a DICOM RT structure set; reads a few elements only.", &is_rtstruct,
           py::arg("path"));
    define(
        m, "read_rtstruct", R"(Reads a DICOM RT structure set with all its ROIs; holes are marked.

Parameters
----------
path : path
images : path, optional
    DICOM images in time, as `read_image_frames` takes them: contours that refer to slices of one frame alone get it.

Returns
-------
StructureSet
)",
        [](const ExistingPath& path, const std::optional<ExistingPath>& images) {
            return unlocked([&] {
                if (!images) return read_rtstruct(path);
                const std::vector<DicomSeries> frames = list_dicom_frames(*images);
                return frames.size() > 1 ? read_rtstruct_in_time(path, frames) : read_rtstruct(path);
            });
        },
        py::arg("path"), py::arg("images") = py::none());
    define(
        m, "select_roi", "The Roi of this name or number; without either, the only one that has contours.",
        [](const StructureSet& structures, const std::optional<RoiName>& name_or_number) {
            return select_roi(structures, roi_name(name_or_number));
        },
        py::arg("structures"), py::arg("name_or_number") = py::none());
}

void bind_writing(py::module_& m) {
    const auto keywords = Keywords<WriteRtstructOptions>()
                              .field("holes", &WriteRtstructOptions::holes, "How the holes of a slice are stored.")
                              .field("series_description", &WriteRtstructOptions::series_description, "")
                              .field("series_number", &WriteRtstructOptions::series_number, "0: the time of day, hhmmss.");
    define(
        m, "write_rtstruct", R"(Writes a DICOM RT structure set that refers to the images it was made on.

Parameters
----------
path : path
structures : StructureSet
images : DicomSeries
    Such as one of `list_dicom_series`.
@on_note
@provenance
@options
)",
        [keywords](const fs::path& path, const StructureSet& structures, const DicomSeries& images,
                   const py::object& on_note, const py::object& provenance, const py::kwargs& given) {
            WriteRtstructOptions options = keywords.parse("write_rtstruct", given);
            options.provenance = provenance_from(provenance);
            give_notes(unlocked([&] { return write_rtstruct(path, structures, images, options); }), on_note);
        },
        py::arg("path"), py::arg("structures"), py::arg("images"), py::kw_only(), kOnNote,
        py::arg("provenance") = py::none(), KeywordText(keywords));
}

}  // namespace

void bind_dicom(py::module_& m) {
    bind_series(m);
    bind_structures(m);
    bind_writing(m);
    define(m, "looks_like_dicom", "Whether a file starts as a DICOM file does, or a folder holds such a file.",
           &looks_like_dicom, py::arg("path"));
    define(
        m, "list_dicom_series", "The volumes in a folder, from the headers: list of DicomSeries.",
        [](const ExistingPath& folder) { return unlocked([&] { return list_dicom_series(folder); }); }, py::arg("folder"));
    define(
        m, "read_dicom_slice", R"(Reads one slice alone, as an image one voxel deep: for previews.

Parameters
----------
path : path
frame : int
    Which slice of a multi-frame file, from 1.

Returns
-------
Image
    As thick as the file says, or 1 mm.
)",
        [](const ExistingPath& path, std::int64_t frame) { return unlocked([&] { return read_dicom_slice(path, frame); }); },
        py::arg("path"), py::arg("frame") = 1);
    const auto keywords = series_keywords();
    define(
        m, "read_dicom_series",
        R"(Reads one volume of a DICOM folder, slices ordered by position, a gantry tilt kept exactly.

Parameters
----------
path : path
    A folder, or one file, which stands for its own series.
@progress
@options

Returns
-------
DicomVolume
)",
        [keywords](const ExistingPath& path, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const DicomSeriesOptions options = keywords.parse("read_dicom_series", given);
            return run({progress, stop}, [&](const Work& work) { return read_dicom_series(path, options, work); });
        },
        py::arg("path"), py::kw_only(), kProgress, kStop, KeywordText(keywords));
    define(
        m, "read_dicom_grid", R"(The same volume's grid, from the headers only.

Parameters
----------
path : path
@progress
@options

Returns
-------
DicomGrid
)",
        [keywords](const ExistingPath& path, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const DicomSeriesOptions options = keywords.parse("read_dicom_grid", given);
            return run({progress, stop}, [&](const Work& work) { return read_dicom_grid(path, options, work); });
        },
        py::arg("path"), py::kw_only(), kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
