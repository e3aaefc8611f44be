// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

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
    py::class_<DicomGrid> grid(m, "DicomGrid", "The same without voxels.");
    grid.def_readonly("grid", &DicomGrid::grid, "Grid");
    grid.def_readonly("series", &DicomGrid::series, "DicomSeries");
    grid.def_readonly("notes", &DicomGrid::notes, "list of str");
}

void bind_structures(py::module_& m) {
    py::class_<Roi> roi(m, "Roi", "One region of interest of an RT structure set.");
    roi.def_readonly("number", &Roi::number, "int");
    roi.def_readonly("name", &Roi::name, "str");
    roi.def_readonly("interpreted_type", &Roi::interpreted_type, "str: 'GTV', 'ORGAN', ...; may be empty.");
    roi.def_readonly("frame_of_reference_uid", &Roi::frame_of_reference_uid, "str");
    roi.def_readonly("color", &Roi::color, "list of 3 int (red, green, blue, 0 to 255), or None.");
    roi.def_readonly("contours", &Roi::contours, "ContourSet: may be empty.");
    roi.def_readonly("notes", &Roi::notes, "list of str: how the stored contours were interpreted.");
    roi.def("__repr__", [](const Roi& r) { return py::str("<Roi {}: {!r}>").format(r.number, r.name); });

    py::class_<StructureSet> set(m, "StructureSet", "An RT structure set.");
    set.def_readonly("label", &StructureSet::label, "str");
    set.def_readonly("rois", &StructureSet::rois, "list of Roi: in the file's order.");

    define(m, "is_rtstruct", "Whether a file is a DICOM RT structure set; reads a few elements only.", &is_rtstruct,
           py::arg("path"));
    define(
        m, "read_rtstruct", "Reads a DICOM RT structure set with all its ROIs; holes are marked: StructureSet.",
        [](const fs::path& path) { return unlocked([&] { return read_rtstruct(path); }); }, py::arg("path"));
    define(
        m, "select_roi", "The Roi of this name or number; without either, the only one that has contours.",
        [](const StructureSet& structures, const std::optional<std::string>& name_or_number) {
            return select_roi(structures, name_or_number);
        },
        py::arg("structures"), py::arg("name_or_number") = py::none());
}

}  // namespace

void bind_dicom(py::module_& m) {
    bind_series(m);
    bind_structures(m);
    define(m, "looks_like_dicom", "Whether a file starts as a DICOM file does, or a folder holds such a file.",
           &looks_like_dicom, py::arg("path"));
    define(
        m, "list_dicom_series", "The volumes in a folder, from the headers: list of DicomSeries.",
        [](const fs::path& folder) { return unlocked([&] { return list_dicom_series(folder); }); }, py::arg("folder"));
    const auto keywords = series_keywords();
    define(
        m, "read_dicom_series",
        R"(Reads one volume of a DICOM folder, slices ordered by position, a gantry tilt kept exactly.

Parameters
----------
path : path
    A folder, or one file, which stands for its own series.
progress, stop : optional
    As for `segment`.
@options

Returns
-------
DicomVolume
)",
        [keywords](const fs::path& path, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const DicomSeriesOptions options = keywords.parse("read_dicom_series", given);
            return run({progress, stop}, [&](const Progress& p) { return read_dicom_series(path, options, p); });
        },
        py::arg("path"), py::kw_only(), kProgress, kStop, KeywordText(keywords));
    define(
        m, "read_dicom_grid", R"(The same volume's grid, from the headers only.

Parameters
----------
path : path
progress, stop : optional
    As for `segment`.
@options

Returns
-------
DicomGrid
)",
        [keywords](const fs::path& path, const py::object& progress, const py::object& stop, const py::kwargs& given) {
            const DicomSeriesOptions options = keywords.parse("read_dicom_grid", given);
            return run({progress, stop}, [&](const Progress& p) { return read_dicom_grid(path, options, p); });
        },
        py::arg("path"), py::kw_only(), kProgress, kStop, KeywordText(keywords));
}

}  // namespace kontur::python
