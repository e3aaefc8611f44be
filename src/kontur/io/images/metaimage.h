// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "kontur/base/work.h"
#include "kontur/io/images/image_view.h"
#include "kontur/io/images/read_image_options.h"

namespace kontur {

/// Reads MetaImage: .mha and .mhd, whose data file, if it is another one, is a plain name in the same folder; raw,
/// zlib-compressed and text voxels, both byte orders, all scalar types, three axes of space and frames or channels. As in
/// ITK, TransformMatrix holds the direction of the first axis, then of the second, then of the third, in LPS, and
/// AnatomicalOrientation is ignored; a missing matrix is the identity and a missing Offset 0, as the format defines. A file
/// without a spacing is refused unless `allow_missing_geometry`. Shear is kept. Errors: corrupt_file, unsupported,
/// too_large, io. Source: MetaIO documentation (Kitware, "MetaIO/Documentation").
Image read_metaimage(const std::filesystem::path& path, const ReadImageOptions& options = {}, const Work& work = {});

/// The geometry alone, from the header.
Grid read_metaimage_grid(const std::filesystem::path& path, const ReadImageOptions& options = {});

/// The file that the header names for its voxels; nullopt when they are behind it or in several files.
std::optional<std::string> metaimage_data_file(const std::filesystem::path& path);

/// Writes .mha, compressed, the same bytes each time. Geometry in double precision, shear included.
void write_metaimage(const std::filesystem::path& path, const ImageView& image);

}  // namespace kontur
