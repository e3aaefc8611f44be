// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "kontur/base/work.h"
#include "kontur/io/images/label_name.h"
#include "kontur/io/images/read_image_options.h"
#include "kontur/shape/provenance.h"
#include "kontur/shape/volume.h"

namespace kontur {

/// Reads a scalar image: NIfTI, NRRD, MetaImage, FreeSurfer's MGH, GIPL, a DICOM series by its folder or one of its files,
/// or the label map of a DICOM segmentation (whose segments must not overlap, unless `read_mask` is asked for one), or a
/// folder with a file of these for each frame, of one grid. The file's name says which, else its content. Geometry arrives
/// in mm, LPS, with its shear. Errors: io, corrupt_file (truncated, lying or contradictory), unsupported (a variant, or an
/// unknown format: the message lists the known ones), too_large, invalid_input (options that fit no frame or series, a limit
/// below 1). Every message names the file.
Image read_image(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone; reads no voxels.
Grid read_grid(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// Reads a label map, or any image as it is. Values that a writer scaled, within 0.001 of an integer each, are rounded, with
/// a note.
Image read_label_image(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// Reads a mask: the voxels with the value `label`, or without one all voxels other than 0. Throws Error(invalid_input),
/// listing the labels in the file, when it holds several and none was chosen, or when the chosen one is not there. Of the
/// segments of a .seg.nrrd that lie on several layers one has to be chosen; where two share a label value, by its place.
Mask read_mask(const std::filesystem::path& path, std::optional<std::int64_t> label = {},
               const ReadImageOptions& options = {}, const Work& work = {});

/// Writes a mask in the format that the name says (.nii, .nii.gz, .nrrd, .seg.nrrd, .mha, .mgz, .mgh), whole or not at all.
/// Inside is the label's value, 1 to 65535: 8-bit samples up to 255, else 16-bit ones; a .seg.nrrd says the rest of it, too.
/// Provenance goes into the text fields: NRRD's key/value pairs; a comment extension of NIfTI and, shortened, its
/// description; MetaImage's comment, shortened; a tag behind MGH's voxels.
/// Throws as check_mask and check_label_value do, and Error(invalid_input) for a colour outside of its range.
void write_mask(const std::filesystem::path& path, const Mask& mask, const LabelName& label = {},
                const Provenance& provenance = {});

/// Writes an image with its sample type, likewise; as .seg.nrrd a label map with one segment for each label, named as in
/// `names` where these know the label; whole numbers that are stored as floats become integers there. Throws
/// Error(invalid_input) for a .seg.nrrd of what is no label map, Error(unsupported) for labels beyond 32 bits in it.
void write_image(const std::filesystem::path& path, const Image& image, const std::vector<LabelName>& names = {},
                 const Provenance& provenance = {});

/// Throws Error(unsupported), as the writers do, for a name whose extension is not among theirs: so that a long computation
/// is refused before it starts.
void check_image_name(const std::filesystem::path& path);

/// Throws Error(invalid_input), as `write_mask` does, for a value that it cannot write.
void check_label_value(std::int64_t value);

}  // namespace kontur
