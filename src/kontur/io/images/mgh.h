// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "kontur/base/work.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/read_image_options.h"

namespace kontur {

/// Reads FreeSurfer's volumes (.mgh, compressed as .mgz): 8-bit, 16-bit and 32-bit integers and floats, frames one behind
/// the other. The header gives spacing, directions of the axes and the centre of the volume (voxel size / 2) in RAS; one
/// that says it does not (goodRASFlag 0) is refused unless `allow_missing_geometry`, which takes FreeSurfer's own default:
/// coronal, 1 mm, centred. Shear is kept. Throws Error(corrupt_file), Error(unsupported) for other samples,
/// Error(too_large). Source: "MGH and MGZ formats" (FreeSurfer wiki, FsTutorial/MghFormat).
Image read_mgh(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone, from the header.
Grid read_mgh_grid(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// What kontur has written behind the voxels of such a file.
Provenance read_mgh_provenance(const std::filesystem::path& path);

/// Writes version 1, compressed unless the name ends with .mgh, the same bytes each time. The geometry is in single
/// precision. 16-bit samples without a sign, which few readers know, become 32-bit ones. How it was made stands behind the
/// voxels among the commands that made a file (tag 3). Throws Error(too_large) for a size beyond 32 bits.
void write_mgh(const std::filesystem::path& path, const ImageView& image);

}  // namespace kontur
