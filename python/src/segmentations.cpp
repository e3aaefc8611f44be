// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/dicom/dicom_seg.h"
#include "notes.h"
#include "provenance.h"

namespace kontur::python {
namespace {

namespace fs = std::filesystem;

DicomSegment segment_from(std::int64_t number, std::string label, std::string algorithm_type, std::string algorithm_name,
                          const std::optional<std::array<std::uint8_t, 3>>& color, std::string description,
                          std::optional<CodedConcept> category, std::optional<CodedConcept> code) {
    return {.number = number,
            .label = std::move(label),
            .algorithm_type = std::move(algorithm_type),
            .algorithm_name = std::move(algorithm_name),
            .color = color,
            .description = std::move(description),
            .category = std::move(category),
            .code = std::move(code)};
}

void bind_types(py::module_& m) {
    py::class_<DicomSegment> segment(m, "DicomSegment", R"(One segment of a DICOM segmentation.

Parameters
----------
number : int
    From 1; the segment's value in label maps.
label : str
    Its name.
algorithm_type : {'SEMIAUTOMATIC', 'AUTOMATIC', 'MANUAL'}
algorithm_name : str
color : (int, int, int), optional
    Red, green, blue, 0 to 255.
description : str
category, code : CodedConcept, optional
    What sort of thing it is, and what it is; written as "tissue" where they are left out.
)");
    const DicomSegment defaults;
    constructor(segment, &segment_from, py::arg("number") = defaults.number, py::arg("label") = defaults.label,
                py::arg("algorithm_type") = defaults.algorithm_type, py::arg("algorithm_name") = defaults.algorithm_name,
                py::arg("color") = py::none(), py::arg("description") = "", py::arg("category") = py::none(),
                py::arg("code") = py::none());
    segment.def_readonly("number", &DicomSegment::number, "int");
    segment.def_readonly("label", &DicomSegment::label, "str");
    segment.def_readonly("algorithm_type", &DicomSegment::algorithm_type, "str");
    segment.def_readonly("algorithm_name", &DicomSegment::algorithm_name, "str: may be empty.");
    segment.def_readonly("color", &DicomSegment::color, "list of 3 int (red, green, blue, 0 to 255), or None.");
    segment.def_readonly("description", &DicomSegment::description, "str: may be empty.");
    segment.def_readonly("category", &DicomSegment::category, "CodedConcept, or None: what sort of thing it is.");
    segment.def_readonly("code", &DicomSegment::code, "CodedConcept, or None: what it is.");
    segment.def_readonly("voxels", &DicomSegment::voxels, "int: set by reading.");
    segment.def_readonly("shared_voxels", &DicomSegment::shared_voxels,
                         "int: those of them that lie in other segments, too; set by reading.");
    segment.def("__repr__",
                [](const DicomSegment& s) { return py::str("<DicomSegment {}: {!r}>").format(s.number, s.label); });

    py::class_<DicomSegmentation> segmentation(m, "DicomSegmentation", "What a DICOM segmentation says about itself.");
    segmentation.def_readonly("grid", &DicomSegmentation::grid, "Grid: from the first to the last stored slice.");
    segmentation.def_readonly("segments", &DicomSegmentation::segments, "list of DicomSegment");
    segmentation.def_readonly("frame_of_reference_uid", &DicomSegmentation::frame_of_reference_uid, "str");
    segmentation.def_readonly("referenced_series_uid", &DicomSegmentation::referenced_series_uid,
                              "str: of the images it was made on; empty when not given.");
    segmentation.def_readonly("notes", &DicomSegmentation::notes, "list of str");
}

/// A mask is the label map of one segment, number 1.
Image labels_from(const py::object& volume) {
    if (!py::isinstance<Mask>(volume)) return volume.cast<const Image&>();
    const auto& mask = volume.cast<const Mask&>();
    return {mask.grid, mask.values};
}

}  // namespace

void bind_segmentations(py::module_& m) {
    bind_types(m);
    define(m, "is_dicom_seg", "Whether a file is a DICOM segmentation; reads a few elements only.", &is_dicom_seg,
           py::arg("path"));
    const py::arg_v max_voxels = py::arg("max_voxels") = std::int64_t{2'200'000'000};
    define(
        m, "read_dicom_segmentation",
        "The DicomSegmentation of a file: its grid and segments, without voxels. Larger grids are refused.",
        [](const ExistingPath& path, std::int64_t most) {
            return unlocked([&] { return read_dicom_segmentation(path, most); });
        },
        py::arg("path"), max_voxels);
    define(
        m, "read_dicom_seg", R"(The label map of a DICOM segmentation: each voxel holds its segment's number.

Parameters
----------
path : path
segment : int, optional
    Read this one alone; needed where segments overlap.
max_voxels : int
    Larger grids are refused.
@on_note
@progress

Returns
-------
Image
)",
        [](const ExistingPath& path, std::optional<std::int64_t> segment, std::int64_t most, const py::object& on_note,
           const py::object& progress, const py::object& stop) {
            DicomSeg seg =
                run({progress, stop}, [&](const Work& work) { return read_dicom_seg(path, segment, most, work); });
            give_notes(seg.notes, on_note);
            return std::move(seg.labels);
        },
        py::arg("path"), py::arg("segment") = py::none(), max_voxels, py::kw_only(), kOnNote, kProgress, kStop);

    define(
        m, "read_dicom_seg_masks", R"(The mask of each segment of a DICOM segmentation, whether they overlap or not.

Parameters
----------
path : path
max_voxels : int
    Refused when all masks together have more.
@progress

Returns
-------
list of Mask
    In the order of `read_dicom_segmentation`, all on its grid.
)",
        [](const ExistingPath& path, std::int64_t most, const py::object& progress, const py::object& stop) {
            return run({progress, stop}, [&](const Work& work) { return read_dicom_seg_masks(path, most, work); });
        },
        py::arg("path"), max_voxels, py::kw_only(), kProgress, kStop);

    const auto algorithm = [](auto member) {
        return [member](WriteDicomSegOptions & options) -> auto& { return options.algorithm.*member; };
    };
    const auto keywords = Keywords<WriteDicomSegOptions>()
                              .field("series_description", &WriteDicomSegOptions::series_description, "")
                              .field("series_number", &WriteDicomSegOptions::series_number, "0: the time of day, hhmmss.")
                              .field("algorithm_name", algorithm(&DicomAlgorithm::name),
                                     "How the segments were made, for those who audit them; empty: nothing is said.")
                              .field("algorithm_version", algorithm(&DicomAlgorithm::version), "")
                              .field("algorithm_parameters", algorithm(&DicomAlgorithm::parameters), "Free text.");
    const auto options_of = [keywords](const char* function, const py::kwargs& given, const py::object& provenance) {
        WriteDicomSegOptions options = keywords.parse(function, given);
        options.provenance = provenance_from(provenance);
        return options;
    };
    define(
        m, "write_dicom_seg", R"(Writes a binary DICOM segmentation that refers to the images it was made on.

Parameters
----------
path : path
labels : Image or Mask
    Its voxels must be voxels of the images; it may be turned, mirrored or cropped against them. A mask is number 1.
segments : sequence of DicomSegment
    One for each value other than 0. In the file they are numbered from 1 in this order.
images : DicomSeries
    Such as one of `list_dicom_series`.
@on_note
@progress
@provenance
@options
)",
        [options_of](const fs::path& path, const py::object& labels, const std::vector<DicomSegment>& segments,
                     const DicomSeries& images, const py::object& on_note, const py::object& progress,
                     const py::object& stop, const py::object& provenance, const py::kwargs& given) {
            const WriteDicomSegOptions options = options_of("write_dicom_seg", given, provenance);
            const Image volume = labels_from(labels);
            give_notes(run({progress, stop},
                           [&](const Work& work) {
                               return write_dicom_seg(path, {volume, segments}, images, options, work);
                           }),
                       on_note);
        },
        py::arg("path"), py::arg("labels"), py::arg("segments"), py::arg("images"), py::kw_only(), kOnNote, kProgress, kStop,
        py::arg("provenance") = py::none(), KeywordText(keywords));
    define(
        m, "write_dicom_seg_masks", R"(Writes a binary DICOM segmentation of segments that may overlap.

Parameters
----------
path : path
masks : sequence of Mask
    One for each segment, otherwise as `labels` of `write_dicom_seg`.
segments : sequence of DicomSegment
    In the file they are numbered from 1 in this order, whatever their numbers are.
images : DicomSeries
    Such as one of `list_dicom_series`.
@on_note
@progress
@provenance
@options
)",
        [options_of](const fs::path& path, const std::vector<Mask>& masks, const std::vector<DicomSegment>& segments,
                     const DicomSeries& images, const py::object& on_note, const py::object& progress,
                     const py::object& stop, const py::object& provenance, const py::kwargs& given) {
            const WriteDicomSegOptions options = options_of("write_dicom_seg_masks", given, provenance);
            give_notes(run({progress, stop},
                           [&](const Work& work) {
                               return write_dicom_seg_masks(path, {masks, segments}, images, options, work);
                           }),
                       on_note);
        },
        py::arg("path"), py::arg("masks"), py::arg("segments"), py::arg("images"), py::kw_only(), kOnNote, kProgress, kStop,
        py::arg("provenance") = py::none(), KeywordText(keywords));
}

}  // namespace kontur::python
