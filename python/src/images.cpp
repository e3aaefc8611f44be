// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "kontur/io/image.h"
#include "kontur/io/image_frames.h"
#include "notes.h"
#include "provenance.h"

namespace kontur::python {
namespace {

namespace fs = std::filesystem;

Keywords<ReadImageOptions> read_keywords() {
    return Keywords<ReadImageOptions>()
        .field("frame", &ReadImageOptions::frame, "Which frame of a 4D image, or of a folder of frames, from 1.")
        .field("prefer", &ReadImageOptions::prefer, "Which transform of a NIfTI file counts when its two differ.")
        .field("allow_missing_geometry", &ReadImageOptions::allow_missing_geometry,
               "Accept an image that does not say where it lies in the patient.")
        .field("max_voxels", &ReadImageOptions::max_voxels, "Larger images are refused.")
        .field(
            "series_uid", [](ReadImageOptions & o) -> auto& { return o.dicom.series_uid; },
            "Which series of a DICOM folder.")
        .field(
            "volume", [](ReadImageOptions & o) -> auto& { return o.dicom.volume; }, "Which volume of the series, from 1.")
        .field(
            "resample_slices", [](ReadImageOptions & o) -> auto& { return o.dicom.resample_slices; },
            "Interpolate slices where they lie unevenly or are missing; else such series are refused.");
}

/// Calls `read` with the options without the interpreter's lock, then gives its notes.
template <class Read>
auto read_with_notes(ReadImageOptions options, const py::object& on_note, const Read& read) {
    std::vector<std::string> notes;
    options.on_note = [&notes](std::string_view note) { notes.emplace_back(note); };
    auto result = unlocked([&] { return read(options); });
    give_notes(notes, on_note);
    return result;
}

/// Between a reader's first line and what it returns.
std::string read_help(const std::string& more_parameters = "") {
    return R"(
Parameters
----------
path : path
    NIfTI, NRRD, MetaImage, a DICOM folder or one of its files, or a folder with such an image for each frame.
)" + more_parameters +
           R"(@on_note
@options
)";
}

void bind_frames(py::module_& m, const Keywords<ReadImageOptions>& keywords) {
    py::class_<ImageFrames> frames(m, "ImageFrames", "The frames of an image over time.");
    frames.def_readonly("count", &ImageFrames::count, "int: how many there are; `read_image` takes a frame from 1 to this.");
    frames.def_readonly("step_s", &ImageFrames::step_s,
                        "float or None: seconds from one to the next; None where the file does not say, or it varies.");
    frames.def_property_readonly("cycle_frames", &ImageFrames::cycle_frames,
                                 "float or None: after so many the motion repeats; None where the file does not say.");
    frames.def_readonly("order", &ImageFrames::order,
                        "str: of frames in files or series of their own, which comes first and last; else empty.");
    const std::string help =
        std::string("How many frames an image has, and what it says of time; reads no voxels.\n") + read_help() + R"(
Returns
-------
ImageFrames
)";
    define(
        m, "read_image_frames", help.c_str(),
        [keywords](const ExistingPath& path, const py::object& on_note, const py::kwargs& given) {
            return read_with_notes(keywords.parse("read_image_frames", given), on_note,
                                   [&](const ReadImageOptions& options) { return read_image_frames(path, options); });
        },
        py::arg("path"), py::kw_only(), kOnNote, KeywordText(keywords));
}

}  // namespace

void bind_images(py::module_& m) {
    const auto keywords = read_keywords();
    bind_frames(m, keywords);
    const std::string image_help =
        std::string("Reads a scalar image with its exact geometry.\n") + read_help(R"(frames : ImageFrames, optional
    What `read_image_frames` said of it: of a folder, the files of the chosen frame alone are opened then.
)") + R"(
Returns
-------
Image
)";
    define(
        m, "read_image", image_help.c_str(),
        [keywords](const ExistingPath& path, const std::optional<ImageFrames>& frames, const py::object& on_note,
                   const py::kwargs& given) {
            return read_with_notes(keywords.parse("read_image", given), on_note, [&](const ReadImageOptions& options) {
                if (!frames) return read_image(path, options);
                const ImageSource one = source_of_frame({path, options}, *frames, options.frame.value_or(1));
                return read_image(one.path, one.options);
            });
        },
        py::arg("path"), py::kw_only(), py::arg("frames") = py::none(), kOnNote, KeywordText(keywords));
    const std::string grid_help = std::string("The geometry of an image file alone; reads no voxels.\n") + read_help() + R"(
Returns
-------
Grid
)";
    define(
        m, "read_grid", grid_help.c_str(),
        [keywords](const ExistingPath& path, const py::object& on_note, const py::kwargs& given) {
            return read_with_notes(keywords.parse("read_grid", given), on_note,
                                   [&](const ReadImageOptions& options) { return read_grid(path, options); });
        },
        py::arg("path"), py::kw_only(), kOnNote, KeywordText(keywords));
    const std::string mask_help = std::string("Reads a mask.\n") + read_help(R"(label : int, optional
    The voxels with this value; needed when the file has several. All that are not 0 when left out.
)") + R"(
Returns
-------
Mask
)";
    define(
        m, "read_mask", mask_help.c_str(),
        [keywords](const ExistingPath& path, std::optional<std::int64_t> label, const py::object& on_note,
                   const py::kwargs& given) {
            return read_with_notes(keywords.parse("read_mask", given), on_note,
                                   [&](const ReadImageOptions& options) { return read_mask(path, label, options); });
        },
        py::arg("path"), py::arg("label") = py::none(), py::kw_only(), kOnNote, KeywordText(keywords));

    const auto writing =
        Keywords<LabelName>()
            .field("label_value", &LabelName::label, "Value inside, 1 to 65535.")
            .field("segment_name", &LabelName::name, "For .seg.nrrd.")
            .field("segment_color", &LabelName::color, "For .seg.nrrd: red, green, blue from 0 to 1.")
            .field(
                "segment_tags", &LabelName::tags,
                "For .seg.nrrd: tags of 3D Slicer, NAME:VALUE with bars between them; 'TerminologyEntry' says what it is.");
    define(
        m, "write_mask", R"(Writes a mask, whole or not at all.

Parameters
----------
path : path
    .nii, .nii.gz, .nrrd, .seg.nrrd or .mha; the name decides on the format.
mask : Mask
@provenance
@options
)",
        [writing](const fs::path& path, const Mask& mask, const py::object& provenance, const py::kwargs& given) {
            const LabelName label = writing.parse("write_mask", given);
            const Provenance facts = provenance_from(provenance);
            const ReleasedLock released;
            write_mask(path, mask, label, facts);
        },
        py::arg("path"), py::arg("mask"), py::kw_only(), py::arg("provenance") = py::none(), KeywordText(writing));
    define(
        m, "write_image", R"(Writes an image with its sample type, whole or not at all.

Parameters
----------
path : path
    .nii, .nii.gz, .nrrd, .seg.nrrd (a label map, one segment for each label) or .mha; the name decides on the format.
image : Image
@provenance
label_names : dict of int to str, optional
    For .seg.nrrd: the names of labels; others are called 'label N'.
label_tags : dict of int to str, optional
    For .seg.nrrd: tags of labels that have a name, as `segment_tags` of `write_mask`.
)",
        [](const fs::path& path, const Image& image, const py::object& provenance,
           const std::map<std::int64_t, std::string>& label_names, const std::map<std::int64_t, std::string>& label_tags) {
            const Provenance facts = provenance_from(provenance);
            std::vector<LabelName> names;
            for (const auto& [label, name] : label_names) names.push_back({label, name});
            for (LabelName& one : names)
                if (const auto tags = label_tags.find(one.label); tags != label_tags.end()) one.tags = tags->second;
            const ReleasedLock released;
            write_image(path, image, names, facts);
        },
        py::arg("path"), py::arg("image"), py::kw_only(), py::arg("provenance") = py::none(),
        py::arg("label_names") = py::dict(), py::arg("label_tags") = py::dict());
}

}  // namespace kontur::python
